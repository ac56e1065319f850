"""Network, PPO and GAE as single functions, for each kernel."""

from typing import Annotated

import numpy
from numpy.typing import NDArray


def param_count(shape: tuple[int, int, int, int]) -> int:
    """
    Floats of a network's flat parameter array; `shape` is (rays, types, touches, dense).
    """

def pack(ray: Annotated[NDArray[numpy.float32], dict(shape=(None, None), order='C', device='cpu', writable=False)], ray_type: Annotated[NDArray[numpy.uint8], dict(shape=(None, None), order='C', device='cpu', writable=False)], touch: Annotated[NDArray[numpy.uint64], dict(order='C', device='cpu', writable=False)], dense: Annotated[NDArray[numpy.float32], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> NDArray[numpy.uint8]:
    """
    Packed observations (n, 192), or (n, 256) if they are wide, from reading + 1 and type of each ray, touch bits (n, 1 or 2) and dense entries.
    """

def unpack(shape: tuple[int, int, int, int], observation: Annotated[NDArray[numpy.uint8], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> NDArray[numpy.float32]:
    """Full observations (n, size)."""

def pair_weights(first: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], second: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> NDArray[numpy.float32]:
    """
    Two weights in the bits of each float: the lower 16 are the second in bfloat16, the whole is near the first.
    """

def forward(kernel: str, shape: tuple[int, int, int, int], params: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], observation: Annotated[NDArray[numpy.uint8], dict(shape=(None, None), order='C', device='cpu', writable=False)], rounded: bool = False) -> NDArray[numpy.float32]:
    """
    Mean (2) and value of each packed observation: (n, 3), by weights as they are or rounded in pairs.
    """

def gradient(kernel: str, shape: tuple[int, int, int, int], config: dict, params: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], observation: Annotated[NDArray[numpy.uint8], dict(shape=(None, None), order='C', device='cpu', writable=False)], action: Annotated[NDArray[numpy.float32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], log_prob: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], advantage: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], target: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], order: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple:
    """
    Gradient and (policy, value, entropy) of the minibatch of the samples in `order`.
    """

def adam(kernel: str, config: dict, gradient: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], params: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], first_moment: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], second_moment: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], updates: int) -> tuple:
    """One Adam step."""

def update(kernel: str, shape: tuple[int, int, int, int], config: dict, params: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], first_moment: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], second_moment: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], updates: int, observation: Annotated[NDArray[numpy.uint8], dict(shape=(None, None), order='C', device='cpu', writable=False)], action: Annotated[NDArray[numpy.float32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], log_prob: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], advantage: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], target: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], order: Annotated[NDArray[numpy.int32], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> tuple:
    """All epochs and minibatches, in the given order (epochs, n)."""

def learn(kernel: str, shape: tuple[int, int, int, int], config: dict, params: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], first_moment: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], second_moment: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], updates: int, observation: Annotated[NDArray[numpy.uint8], dict(shape=(None, None), order='C', device='cpu', writable=False)], action: Annotated[NDArray[numpy.float32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], log_prob: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], value: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], reward: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], bootstrap: float, seed: int, agent_id: int, step: int) -> tuple:
    """Advantages, order and update of one learner."""

def gae(config: dict, reward: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], value: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], bootstrap: float) -> tuple:
    """Advantage and value target of each step."""

def permutation(seed: int, agent_id: int, step: int, count: int, epochs: int) -> NDArray[numpy.int32]:
    """The order (epochs, count) that `learn` uses."""

def init_network(shape: tuple[int, int, int, int], seed: int, agent_id: int = 0, step: int = 0) -> NDArray[numpy.float32]:
    """Initial parameters."""
