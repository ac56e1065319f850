"""Fitness measured directly: founders with chosen genes compete, and their descendants are counted."""
