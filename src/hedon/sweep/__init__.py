"""The file of a sweep: factors, their design, and the conditions that follow from them."""
