"""A stranger's strategy, in a package of its own, cleans: in process, and named to the nodes."""

import pytest

MISSION = '''
from rumba_cleaning import strategies
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.maps import map_file
strategies.load("zigzag_strategy.zigzag")
trial = Trial(map_file.load("{maps}/studio.yaml"), "zigzag", seed=3)
while trial.world.floor.coverage < 0.5 and not trial.is_over:
    trial.step()
print(trial.missions[0].strategy, trial.world.floor.coverage >= 0.5)
'''


@pytest.mark.thorough(except_for=['install'])
@pytest.mark.parametrize('space', ['devel', 'install'])
def test_it_cleans_half_the_studio_in_process(overlay, space):
    stranger = overlay.space(space)
    maps = stranger.run('rospack find rumba_sim').strip() + '/maps'
    assert stranger.run(f"python3 -c '{MISSION.format(maps=maps)}'", timeout=300.0) == 'zigzag True\n'


def test_the_evaluation_knows_it_by_its_module(overlay, tmp_path):
    stranger = overlay.space('devel')
    output = stranger.run('rosrun rumba_evaluation evaluate --import zigzag_strategy.zigzag --strategies zigzag '
                          f'--maps studio --seeds 1 --target 0.3 --no-plots --output {tmp_path}', timeout=300.0)
    assert 'zigzag' in output
