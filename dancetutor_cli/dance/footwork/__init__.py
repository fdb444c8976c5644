"""From a play to a plan: when each foot leaves and lands, where, and how it is turned.

A rule is asked about a row (or a wait) and the footing as it is, changes neither, and returns what it proposes:
another footing (`footing.Proposal`) or a walk (`walks.WalkProposal`). Only `planner` applies a proposal.
"""
