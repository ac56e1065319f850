"""Single agents: how long they live, what they eat, how many children they have."""
