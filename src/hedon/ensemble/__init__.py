"""Many worlds: which are needed, which exist, and how the rest is run, on one machine or on many."""
