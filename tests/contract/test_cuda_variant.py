"""On the emulated device, every variant of the CUDA kernels gives the same bits as AVX2."""

import pytest
from cuda_emulation import VARIANTS, emulate
from worlds import make_simulation

QUICK = (VARIANTS[0], VARIANTS[-1])
"""The default and the variant that differs most; `make test-long` builds all, each in about 15 seconds."""
SHARED = "shared_bodies"
SHORT = ("world.rollout_steps=16", "learning.minibatch_size=8", "learning.update_epochs=2")
SIZES = {"capacity": 12, "initial_count": 6}
SETTINGS = {
    "baseline": ("birth.kappa=0.3", "hazard.kappa=0.01", *(f"population.{size}={n}" for size, n in SIZES.items())),
    "predator": tuple(
        f"species.{name}.population.{size}={n}" for name in ("prey", "predator") for size, n in SIZES.items()
    ),
}
SEEDS = {"baseline": range(1, 10), "predator": range(1, 3)}
"""More worlds than the emulated devices have concurrent learners, so variants that group worlds have several groups."""


@pytest.mark.parametrize("preset", SETTINGS)
@pytest.mark.parametrize(
    "variant", [pytest.param(each, marks=() if each in QUICK else pytest.mark.long) for each in VARIANTS]
)
def test_a_variant_has_the_same_bits(variant: str, preset: str, monkeypatch: pytest.MonkeyPatch):
    """Two windows and the start of the third."""
    emulated = emulate(monkeypatch, variant=variant)
    one, other = (
        make_simulation(*SHORT, *SETTINGS[preset], preset=preset, seeds=tuple(SEEDS[preset]), backend=backend)
        for backend in ("avx2", emulated)
    )
    for simulation in (one, other):
        simulation.run(37)
    assert [world.digest() for world in one.worlds] == [world.digest() for world in other.worlds]


def test_groups_of_worlds_that_run_at_the_same_time_have_the_same_bits(monkeypatch: pytest.MonkeyPatch):
    """Kernels of several groups, and the threads of their blocks, run as system threads."""
    emulated = emulate(monkeypatch, 32, system_threads=True, variant="overlap_two_learners")
    tiny = ("world.rollout_steps=4", "learning.minibatch_size=4", "learning.update_epochs=1")
    sizes = ("population.capacity=6", "population.initial_count=4")
    one, other = (make_simulation(*tiny, *sizes, seeds=tuple(range(6)), backend=each) for each in ("avx2", emulated))
    for simulation in (one, other):
        simulation.run(9)
    assert [world.digest() for world in one.worlds] == [world.digest() for world in other.worlds]


@pytest.mark.long
@pytest.mark.parametrize(
    "settings",
    [
        ("population.capacity=400", "population.initial_count=390", "arena.width=2000", "arena.height=2000"),
        ("population.capacity=64", "population.initial_count=60", "physics.neighbor_skin=300"),
        ("population.capacity=64", "population.initial_count=60", "physics.solver=jacobi"),
        ("population.capacity=64", "population.initial_count=60", "food.normal.growth_rate=5"),
    ],
    ids=["more bodies than fit", "more pairs than fit", "jacobi", "many meals"],
)
def test_arrays_that_do_not_fit_into_shared_memory_stay_where_they_were(settings: tuple[str, ...], monkeypatch):
    """Each array is placed separately in every step."""
    emulated = emulate(monkeypatch, variant=SHARED)
    one, other = (make_simulation(*SHORT, *settings, backend=backend) for backend in ("avx2", emulated))
    for simulation in (one, other):
        simulation.run(37)
    assert [world.digest() for world in one.worlds] == [world.digest() for world in other.worlds]
