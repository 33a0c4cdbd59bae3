# SPDX-License-Identifier: LGPL-2.1-or-later
"""billet-trade: what accuracy costs in a scene of billet, by parameter. doc/guide/trade.md shows its use.

command    the command line
plan       what is run: the scene in pilot form, and the points of the sweep
parameters what can be changed, and what the reference changes
reference  the converged reference, and its runs
run        running, and keeping what came out
results    what a run gave, as it is kept
outputs    the outputs whose errors count
measure    pure: norms, Richardson extrapolation, Pareto front, the choice
sweep      the order of things: runs, judges and writes
report     table, CSV and words; picture draws
"""
