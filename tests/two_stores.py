"""Two stores besides energy, used in many tests: one that must be refilled, and one that weakens the motors."""

STORES = (
    "store.nutrient={capacity=400.0, initial=40.0, basic_cost=1e-4, action_cost=2e-6}",
    *("store.nutrient.child_share=0.4", "store.nutrient.hazard_weight=0.2"),
    "store.toxin={capacity=1e6, basic_cost=0.01, motor_threshold=5.0, scale=10.0, set_point={initial_mean=0.0}}",
)
FED = (*STORES, "food.normal.gives.nutrient=1", "food.normal.gives.toxin=1")
"""The same stores, and a kind of food that fills both."""
