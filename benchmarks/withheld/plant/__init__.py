"""Plants that make the withheld cases.  They share no code with the package under test, on purpose."""
