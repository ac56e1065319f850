"""The reproduction of the paper: its reports and claims, its figures and tables, and our studies of open questions."""
