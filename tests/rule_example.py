"""Rules in Python for tests: rewards, one of them with a memory, hazards and chances of birth."""


def curious(agent):
    """Rewards deviations from what the agent is used to, and coming closer to an energy of 2."""
    surprise = abs(agent.nearness - agent.memory_1)
    agent.memory_1 += 0.1 * (agent.nearness - agent.memory_1)
    agent.memory_2 += agent.normal + 0.01 * agent.moved
    relief = abs(agent.energy_before - 2.0) - abs(agent.energy - 2.0)
    thrust = agent.force_left - agent.force_right
    return agent.linear + agent.w_action * surprise + agent.w_normal * relief + 1e-3 * thrust * agent.action


def swamp(agent):
    """More deadly on the left, and for agents that remember a lot."""
    worse = 0.02 if agent.x < 100.0 and agent.y > 50.0 else 0.0
    return min(agent.chance + worse + 0.001 * agent.memory_2 + 1e-6 * agent.age, 1.0)


def crowded(agent):
    """No births in a crowd, and none in every fifth step."""
    return 3.0 * agent.chance if agent.alive < 20.0 and agent.step % 5.0 > 0.0 else 0.0


def kind(agent):
    """Rewards nearby kin, and others depending on where the nearest one is."""
    toward = 1.0 if abs(agent.near_bearing) < 1.0 and agent.near_distance < 25.0 else 0.0
    crowd = 0.1 * agent.extra_patience * agent.near_count - 0.01 * agent.guard_count
    return agent.linear + agent.extra_kindness * agent.near_kin + toward + crowd + 0.01 * agent.near_bearing


def lonely(agent):
    """More deadly for agents that are alone or have their nearest neighbor behind them."""
    return min(agent.chance + (0.01 if agent.near_count == 0.0 or abs(agent.near_bearing) > 2.0 else 0.0), 1.0)


def apart(agent):
    """No births near kin."""
    return 0.0 if agent.all_kin > 1.0 else agent.chance
