from collections import Counter
from importlib.resources import files

import yaml

from unicon.motion.catalogue.by_hand import by_hand
from unicon.motion.catalogue.classes import normalize


def test_no_file_is_named_in_two_groups():
    text = files("unicon.motion.catalogue").joinpath("by_hand.yaml").read_text(encoding="utf-8")
    keys = Counter(key for group in yaml.safe_load(text)["takes"] for key in group)
    assert [key for key, count in keys.items() if count > 1] == []


def test_classes_by_hand_are_written_as_classes_are():
    assert all(normalize(path) == path for path in by_hand().classes.values())


def test_partners_point_to_the_first_of_a_pair():
    assert by_hand().partners[61] == 60
    assert 60 not in by_hand().partners
