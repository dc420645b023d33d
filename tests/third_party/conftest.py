"""Settings for the contract tests of third parties: fewer examples, since each law has tests of its own."""

import hypothesis

hypothesis.settings.register_profile("third-party", derandomize=True, deadline=None, max_examples=15)
hypothesis.settings.load_profile("third-party")
