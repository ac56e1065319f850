"""Mating strategies: do agents that only forage and agents that seek mates live together?"""
