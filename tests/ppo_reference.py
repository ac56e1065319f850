"""PPO in plain NumPy and float64, the reference for the kernels. Source: Schulman et al. (2017)."""

from __future__ import annotations

from typing import Any

import numpy as np

HIDDEN = 64


def split(params: np.ndarray, inputs: int) -> dict[str, np.ndarray]:
    """Views of each layer in the flat array of parameters."""
    sizes = {
        "w1": (inputs, HIDDEN),
        "b1": (HIDDEN,),
        "w2": (HIDDEN, HIDDEN),
        "b2": (HIDDEN,),
        "w3": (3, HIDDEN),
        "b3": (3,),
        "log_sd": (2,),
    }
    layers, at = {}, 0
    for name, shape in sizes.items():
        length = int(np.prod(shape))
        layers[name] = params[at : at + length].reshape(shape)
        at += length
    return layers


def forward(params: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Both hidden layers and the outputs (mean 2, value 1)."""
    p = split(params, x.shape[1])
    h1 = np.tanh(x @ p["w1"] + p["b1"])
    h2 = np.tanh(h1 @ p["w2"] + p["b2"])
    return h1, h2, h2 @ p["w3"].T + p["b3"]


def losses(params: np.ndarray, x: np.ndarray, sample: tuple[np.ndarray, ...], settings: dict[str, Any]):
    """Policy loss, value loss, entropy; `sample` is (action, log_prob, advantage, target)."""
    action, old_log_prob, advantage, target = sample
    log_sd = split(params, x.shape[1])["log_sd"]
    output = forward(params, x)[2]
    scaled = (action - output[:, :2]) / np.exp(log_sd)
    log_prob = (-0.5 * scaled**2 - log_sd - 0.5 * np.log(2 * np.pi)).sum(1)
    ratio = np.exp(log_prob - old_log_prob)
    clipped = np.clip(ratio, 1 - settings["clip_coef"], 1 + settings["clip_coef"])
    policy = -np.minimum(ratio * advantage, clipped * advantage).mean()
    if settings["critic_target"] == "batch_mean":
        value = 0.5 * ((output[:, 2][:, None] - target[None, :]) ** 2).mean()
    else:
        value = 0.5 * ((output[:, 2] - target) ** 2).mean()
    return policy, value, (log_sd + 0.5 + 0.5 * np.log(2 * np.pi)).sum()


def loss(params: np.ndarray, x: np.ndarray, sample: tuple[np.ndarray, ...], settings: dict[str, Any]) -> float:
    """The loss whose gradient is `gradient`."""
    policy, value, entropy = losses(params, x, sample, settings)
    return policy + settings["value_coef"] * value - settings["entropy_coef"] * entropy


def gradient(params: np.ndarray, x: np.ndarray, sample: tuple[np.ndarray, ...], settings: dict[str, Any]):
    """The derivative of `loss` with respect to every parameter, by the chain rule."""
    action, old_log_prob, advantage, target = sample
    count = len(x)
    p = split(params, x.shape[1])
    h1, h2, output = forward(params, x)
    sd = np.exp(p["log_sd"])
    scaled = (action - output[:, :2]) / sd
    log_prob = (-0.5 * scaled**2 - p["log_sd"] - 0.5 * np.log(2 * np.pi)).sum(1)
    ratio = np.exp(log_prob - old_log_prob)
    outside = np.where(advantage > 0, ratio > 1 + settings["clip_coef"], ratio < 1 - settings["clip_coef"])
    by_log_prob = np.where(outside, 0.0, -advantage * ratio) / count
    wanted = target.mean() if settings["critic_target"] == "batch_mean" else target
    by_output = np.empty((count, 3))
    by_output[:, :2] = by_log_prob[:, None] * scaled / sd
    by_output[:, 2] = settings["value_coef"] * (output[:, 2] - wanted) / count
    by_sum2 = by_output @ p["w3"] * (1 - h2**2)
    by_sum1 = by_sum2 @ p["w2"].T * (1 - h1**2)
    out = np.zeros_like(params)
    g = split(out, x.shape[1])
    g["w1"][:], g["b1"][:] = x.T @ by_sum1, by_sum1.sum(0)
    g["w2"][:], g["b2"][:] = h1.T @ by_sum2, by_sum2.sum(0)
    g["w3"][:], g["b3"][:] = by_output.T @ h2, by_output.sum(0)
    g["log_sd"][:] = (by_log_prob[:, None] * (scaled**2 - 1)).sum(0) - settings["entropy_coef"]
    return out


class Adam:
    """Adam, following algorithm 1 of Kingma and Ba (2015)."""

    def __init__(self, settings: dict[str, Any], size: int) -> None:
        self.settings = settings
        self.m = np.zeros(size)
        self.v = np.zeros(size)
        self.step = 0

    def __call__(self, params: np.ndarray, slope: np.ndarray) -> np.ndarray:
        s = self.settings
        self.step += 1
        self.m = s["adam_beta1"] * self.m + (1 - s["adam_beta1"]) * slope
        self.v = s["adam_beta2"] * self.v + (1 - s["adam_beta2"]) * slope**2
        m_hat = self.m / (1 - s["adam_beta1"] ** self.step)
        v_hat = self.v / (1 - s["adam_beta2"] ** self.step)
        return params - s["learning_rate"] * m_hat / (np.sqrt(v_hat) + s["adam_epsilon"])


def update(
    params: np.ndarray,
    x: np.ndarray,
    samples: tuple[np.ndarray, ...],
    order: np.ndarray,
    settings: dict[str, Any],
) -> tuple[np.ndarray, np.ndarray]:
    """Runs all epochs and minibatches; returns the parameters and the mean losses of the last epoch."""
    adam = Adam(settings, len(params))
    size = settings["minibatch_size"]
    seen = []
    for epoch in order:
        seen = []
        for chosen in epoch.reshape(-1, size):
            sample = tuple(values[chosen] for values in samples)
            seen.append(losses(params, x[chosen], sample, settings))
            params = adam(params, gradient(params, x[chosen], sample, settings))
    return params, np.mean(seen, axis=0)
