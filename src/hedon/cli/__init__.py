"""The command line: each command parses, calls and prints; heavy libraries are imported within commands."""
