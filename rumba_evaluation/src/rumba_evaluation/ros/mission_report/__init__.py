"""The command mission_report: reads a bag and writes a report of the mission."""
