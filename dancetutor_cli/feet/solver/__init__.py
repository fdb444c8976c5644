"""The solver: cost preset -> transition tables -> dynamic programme -> Play (who steps what, and what it costs).

    solve, engine                 a play of rows and a preset; tables of one pad and preset, and their kernel run
      |   vocabulary, packing       names of costs; the pad and the preset as arrays; bits of packed words
      |   state                     how the dancer stands between two rows
      |   itg_moves, itg_costs      ways to play a row, and their costs, in the model `itg`
      |   thesis_moves              the same in the model `thesis`
      |   tables, kernel, solvers   states and ways by number; the dynamic programme; one for each model
    techniques                    names of what happens in a play: crossover, jack, spin
    alternatives                  other plays, and why a foot has to step twice

A module that says "Kernel code" is compiled by `run.kernels`, or runs as Python: `compiled`.
"""
