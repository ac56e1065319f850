"""Two needs: is a reward for reducing drives fitter than pay per meal, and only where agents have two needs?"""
