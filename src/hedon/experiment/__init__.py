"""The engine as Python objects, and the loop that advances it, writes records, and continues from checkpoints."""
