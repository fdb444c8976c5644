"""From a play to a plan: when each foot leaves and lands, where, and how it is turned.

    footing                       the state of both feet, row by row: the row for the rules, holds, palms on panels
      |   turning, foothold         how the body turns with the feet; how a foot lands on its panel
      |   flights, mines, steps     both feet in the air; feet that rise from mines; steps, brackets, jumps
      |   footfalls                 footsteps from one stand to another
      |   walks, homing             walks onto the pad, off it, between pads, aside; steps back home in waits
    planner                       calls the rules at each row and in each wait, and makes the `plan.Plan`

A rule takes a row (or a wait) and the footing, and changes neither. It returns its proposal: another footing
(`footing.Proposal`) or a walk (`walks.WalkProposal`). Only `planner` applies proposals.
"""
