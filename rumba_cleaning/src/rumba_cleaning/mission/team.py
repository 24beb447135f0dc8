"""Has the missions of a team hear of one another, in process."""

from typing import Mapping

from rumba_cleaning.mission.stages import StagedMission


def tell_mates(missions: Mapping[str, StagedMission]) -> None:
    """Have each mission hear what the others, by the names of their robots, do; as nodes do before the next step."""
    if len(missions) == 1:
        return
    reports = {name: mission.report() for name, mission in missions.items()}
    for listener, mission in missions.items():
        for name, report in reports.items():
            if name != listener and report is not None:
                mission.hear(name, report)
