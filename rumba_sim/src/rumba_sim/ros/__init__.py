"""The ROS face of the model: a folder for each node of several modules, and what the nodes of all packages share."""

from rumba_sim.ros.common import definitions

definitions.take_ours()
