"""How fast are Campbell diagrams and prescribed run-ups, beside ROSS in an environment of its own?"""
