"""`python -m halfrow_labgrid`, as the program halfrow-labgrid."""
from .command import main

main()
