"""Coevolution in your own loop, which stops after ten turns without a better pair."""

import evoframe

config = evoframe.load_config("quick", overrides=["run.generations=30", "aggregator=am"])
patience, waited = 10, 0
with evoframe.assemble(config) as coevolution:
    for turn in coevolution:
        waited = 0 if turn.best_pair else waited + 1
        if waited == patience:
            break
if coevolution.best_score is not None:
    print(f"best score after {coevolution.turn} turns: {1000 * coevolution.best_score:.2f} mm")
