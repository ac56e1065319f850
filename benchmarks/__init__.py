"""How fast hedon is: single parts and whole worlds, compared with what the machine can do at that moment.

The command is `python -m benchmarks`, in a checkout. Every measurement is checked before it is printed; a JSON file
gets the raw numbers.
"""
