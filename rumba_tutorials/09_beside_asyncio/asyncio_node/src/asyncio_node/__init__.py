"""rospy beside an asyncio loop."""
