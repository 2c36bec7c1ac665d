"""Speed that does not depend on the machine's mood: instructions per simulated millisecond."""

import shutil
import sys

import pytest

from conftest import ROOT

sys.path.insert(0, str(ROOT / "benches"))
import instructions  # noqa: E402


@pytest.mark.skipif(not shutil.which("valgrind"), reason="valgrind is missing")
def test_instructions_per_simulated_millisecond_keep_their_budget(fmu, tmp_path):
    """At most 3 % over the last line of benches/instructions.csv, which says where it comes from."""
    count, budget = instructions.count(fmu, tmp_path), instructions.budget()
    assert count <= 1.03 * budget, (
        f"{count:.0f} instructions per simulated ms are {100 * (count / budget - 1):.1f} % over the budget of "
        f"{budget:.0f}; if that is worth it, say why: benches/instructions.py --rebase WHY")
