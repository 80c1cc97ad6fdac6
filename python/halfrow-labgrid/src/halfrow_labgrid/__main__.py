"""`python -m halfrow_labgrid`: the same as the program halfrow-labgrid."""
from .command import main

main()
