"""A tyre's tread block in Python: a thin layer over TreadBlock.fmu, no second model.

    from tread_block import TreadBlock

    block = TreadBlock({"block.height": 0.008, "friction.mu_inf": 0.6})
    run = block.slide(speed=0.3, pressure=250e3)       # a pandas frame over time [s]
    run["run_in.velocity.x"].plot(ylabel=run.attrs["units"]["run_in.velocity.x"])
"""

from .block import TreadBlock, TreadBlockError, Variable

__all__ = ["TreadBlock", "TreadBlockError", "Variable"]
