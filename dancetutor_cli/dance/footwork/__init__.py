"""From a play to a plan: when each foot leaves and lands, where, and how it is turned.

    footing                       both feet row by row: the row as rules see it, holds, palms on panels
      |   turning, foothold         how the body turns with the feet; how a foot comes down on its panel
      |   flights, mines, steps     both feet in the air; feet that go up from mines; steps, brackets, jumps
      |   footfalls                 footsteps from one stand to another
      |   walks, homing             onto the pad, off it, between pads, aside; feet that step back home in waits
    planner                       asks the rules at each row and in each wait, and makes the `plan.Plan`

A rule gets a row (or a wait) and the footing, and changes neither. It returns its proposal: another footing
(`footing.Proposal`) or a walk (`walks.WalkProposal`). Only `planner` applies proposals.
"""
