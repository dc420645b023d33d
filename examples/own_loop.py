"""Coevolution in a loop of your own: stop when nothing better was found for a while."""

import evoframe

config = evoframe.load_config("quick", overrides=["run.generations=30", "aggregator=am"])
patience, waited = 10, 0
with evoframe.assemble(config) as coevolution:
    for turn in coevolution:
        waited = 0 if turn.best_pair else waited + 1
        if waited == patience:
            break
print(f"best displacement after {coevolution.turn} turns: {coevolution.best_score} m")
