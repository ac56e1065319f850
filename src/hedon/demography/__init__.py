"""What follows from the settings alone, before any run: lives, births, room for newborns, and what limits a world."""
