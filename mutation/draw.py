"""Run by the Python of cosmic-ray: leaves so many of a session's faults to be planted, drawn by a seed."""

import random
import sys

from cosmic_ray.work_db import WorkDB, use_db
from cosmic_ray.work_item import WorkerOutcome, WorkResult

path, most, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
with use_db(path, WorkDB.Mode.open) as session:
    pending = sorted(session.pending_work_items, key=lambda item: str(item.mutations))  # identifiers are random
    random.Random(seed).shuffle(pending)
    session.set_multiple_results([item.job_id for item in pending[most:]], WorkResult(WorkerOutcome.SKIPPED))
