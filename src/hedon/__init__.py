"""Study how reward systems evolve: agents that live, learn, breed and die in a continuous world."""
