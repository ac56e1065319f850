"""A run's frames as a video: moments of a world, and the program that encodes their pictures."""
