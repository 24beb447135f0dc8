"""The picture of the stages of a plan can be drawn: its script uses what the planner is made of."""

import subprocess
import sys

from PIL import Image
from workspaces import ROOT


def test_the_stages_of_a_plan_can_be_drawn(tmp_path):
    path = tmp_path / 'stages.png'
    subprocess.run([sys.executable, str(ROOT / 'docs' / 'pictures' / 'stages.py'), str(path)], check=True)
    with Image.open(str(path)) as picture, Image.open(str(ROOT / 'docs' / 'pictures' / 'stages.png')) as shown:
        assert picture.size == shown.size and len(picture.convert('RGB').getcolors(1 << 20)) > 20
