"""Rules in Python for worlds of tests."""


def curious(agent):
    surprise = abs(agent.nearness - agent.memory_1)
    agent.memory_1 += 0.1 * (agent.nearness - agent.memory_1)
    agent.memory_2 += 1.0
    return agent.linear + agent.w_action * surprise


def swamp(agent):
    return min(agent.chance + (0.02 if agent.x < 80.0 else 0.0), 1.0)


def uncrowded(agent):
    return agent.chance if agent.alive < 20.0 else 0.0


def kind(agent):
    near = agent.any_count + 0.1 * agent.any_bearing + 0.01 * agent.any_distance + agent.any_kin
    return agent.linear + 0.1 * agent.extra_kindness * (agent.own_kin + 0.01 * agent.own_count) + 1e-3 * near
