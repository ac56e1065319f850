"""How fast hedon is: parts by themselves and whole worlds, beside what the machine could do in the same minute.

`hedon bench` is its face. Every number is checked for sense before it is printed, and kept raw in a JSON file.
"""
