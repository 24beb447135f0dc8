"""rospy and an asyncio loop in one program."""
