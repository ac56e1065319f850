"""What the paper claims, what would count as its being so, and whether it is so in some worlds."""
