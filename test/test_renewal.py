"""Pages of results are updated by their own commands."""

import re
import sys

import pytest
from workspaces import ROOT

sys.path.insert(0, str(ROOT / 'bench'))
from common import renewal  # noqa: E402

PAGE = '''# Results

`./rumba shell printf 'a\\nb\\n'`, beside
other work:

```
old
```

Recorded at 1234567.

More.

`./rumba shell sh -c
"exit 3"`

```
stays
```

`./rumba shell map FOLDER`

```
by hand
```

`./rumba shell two`

```
1
```

and

```
2
```
'''


def test_the_output_of_a_command_replaces_its_block_with_the_commit(tmp_path):
    path = tmp_path / 'results_x.md'
    path.write_text(PAGE)
    assert sorted(renewal.renew(path, 'abcdef01')) == [
        'results_x.md: exit code 3, nothing is changed: sh -c "exit 3"', 'results_x.md: run by hand: map FOLDER',
        'results_x.md: run by hand: two', "results_x.md: written: printf 'a\\nb\\n'"]
    assert path.read_text() == PAGE.replace('old', 'a\nb').replace('1234567', 'abcdef01')


def test_most_commands_of_the_pages_can_be_run_so():
    found = [renewal.parts(path.read_text()) for path in sorted(ROOT.glob('docs/results_*.md'))]
    commands = [part.command for ready, _ in found for part in ready]
    assert len(commands) > 20 and sum(len(by_hand) for _, by_hand in found) < 15
    for command in commands:
        program = re.match(r'python3 (bench/\w+\.py)', command)
        assert command.startswith('rosrun rumba_evaluation ') or (ROOT / program.group(1)).exists(), command


def test_an_unknown_page_is_refused(capsys):
    assert renewal.main(('results_speed', 'speed')) == 2
    assert capsys.readouterr().err.startswith('bench: there is no page speed: known are results_cleaning, ')


@pytest.mark.parametrize('path', sorted(ROOT.glob('docs/results_*.md')), ids=lambda path: path.name)
def test_a_block_that_is_written_again_as_it_is_changes_only_the_commit(path):
    page = path.read_text()
    for part in renewal.parts(page)[0]:
        block = page[part.begin:part.end]
        output, commit = re.match(r'```\n(.*?)```\n\nRecorded at (\w+)\.\n$', block, re.DOTALL).groups()
        assert renewal.renewed(page, part, output, commit) == page, part.command
