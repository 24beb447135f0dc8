"""The command mission_report: from a bag to the record of a mission."""
