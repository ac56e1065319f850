"""Many worlds: which are needed, which exist, and how to run the rest on one machine or several."""
