import pytest

from unicon.errors import UniconError
from unicon.train.runs.state_file import write_in_one_step


def test_a_file_is_replaced_and_nothing_is_left_beside_it(tmp_path):
    path = tmp_path / "plan.json"
    write_in_one_step(path, "old")
    write_in_one_step(path, "new")
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


def test_where_it_cannot_be_written_the_old_file_stays(tmp_path):
    path = tmp_path / "plan.json"
    write_in_one_step(path, "old")
    # a full device in the place where the new file is made
    (tmp_path / ".plan.json.part").symlink_to("/dev/full")
    with pytest.raises(UniconError, match=r"plan.json: cannot be written \(No space left"):
        write_in_one_step(path, "new")
    assert path.read_text() == "old"
