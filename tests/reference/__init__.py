"""The rules of a world once more, in plain and slow Python: read `model.py` first.

Written from docs/model.md, not from the engine, but with the same counted random numbers, so that the engine's every
decision can be predicted. Physics, rays and the learning of networks have judges of their own.
"""
