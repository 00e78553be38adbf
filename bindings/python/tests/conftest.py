# SPDX-License-Identifier: Apache-2.0
"""Settings of hypothesis: the same examples every time, as many as the test run has time for."""

import os

from hypothesis import HealthCheck, settings

settings.register_profile(
    "pierce", derandomize=True, deadline=None, database=None,
    max_examples=int(os.environ.get("PIERCE_EXAMPLES", "100")),
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
settings.load_profile("pierce")
