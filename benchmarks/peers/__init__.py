"""One shared problem for Atoll, pygmo, LEAP and DEAP: the sides that are run, each in a process of its own."""
