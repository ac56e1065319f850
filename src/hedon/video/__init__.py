"""Makes videos from the frames of a run: moments of a world, and the program that encodes their pictures."""
