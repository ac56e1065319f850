"""Optimal reward: is a liking for water fit if water is only a means to eat?"""
