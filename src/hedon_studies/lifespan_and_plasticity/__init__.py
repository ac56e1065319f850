"""Lifespan and plasticity: do short lives and changing worlds make agents learn faster?"""
