"""Which reward is fit depends on how its owner learns; expected.md has the design and what we expect."""
