"""The command line: each command parses, calls and prints. Large libraries are imported inside the commands."""
