"""From a play to a plan: when each foot leaves and lands, where, and how it is turned.

A rule gets a row (or a wait) and the footing, and changes neither. It returns its proposal: another footing
(`footing.Proposal`) or a walk (`walks.WalkProposal`). Only `planner` applies proposals.
"""
