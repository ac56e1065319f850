"""Work in processes of its own, on one machine or on many."""
