"""Tests for policy_export.py and model_card.py: the folder of a policy, and ONNX against the executor."""

from __future__ import annotations

import json

import numpy as np
import pytest

from tests.samples import swaying_clip
from tests.train.policy_samples import make_card, make_weights
from unicon.errors import InputFileError
from unicon.policy import PolicyContext
from unicon.policy_file import CARD_FILE, PolicyMismatchError, read_policy
from unicon.policy_library import load_policy
from unicon.train.scoring.evaluation import evaluate
from unicon.train.scoring.evaluation_clips import from_clips
from unicon.train.scoring.evaluation_report import as_json, write_json
from unicon.train.scoring.policy_export import export_policy, take_in_scores
from unicon.train.scoring.robustness import measure_robustness, robustness_as_json


@pytest.mark.parametrize("activation", ["relu", "elu", "silu", "tanh"])
def test_onnx_computes_what_the_executor_computes(tmp_path, activation):
    runtime = pytest.importorskip("onnxruntime")
    card = make_card(activation=activation, tau=2, future=(1, 4), action="pd")
    export_policy(tmp_path / "p", card, make_weights(card))
    session = runtime.InferenceSession(str(tmp_path / "p" / "policy.onnx"))
    seen = 4.0 * np.random.default_rng(1).standard_normal((50, card.input_size))
    (action,) = session.run(None, {"observation": seen.astype(np.float32)})
    expected = make_weights(card).evaluate(seen, activation)
    assert np.abs(action - expected).max() < 1e-5
    assert np.abs(expected).max() > 0.1
    properties = session.get_modelmeta().custom_metadata_map
    assert (properties["future_ticks"], properties["action"]) == ("1,4", "pd")


def test_an_exported_policy_is_what_the_executor_loads(tmp_path):
    card = make_card(tau=1, future=(2,), action="torque-servo", training="laptop, 2 h at 30 Hz with pd")
    export_policy(tmp_path / "p", card, make_weights(card))
    policy = load_policy(f"{tmp_path}/p")
    frames = swaying_clip(20).frames
    control = policy.act(PolicyContext(frames[3], frames[4:6]))
    assert policy.tau == 2
    assert np.isfinite(control.torque).all()
    text = (tmp_path / "p" / "README.md").read_text()
    assert "2/60 s ahead" in text and "laptop, 2 h at 30 Hz" in text and "Not evaluated yet" in text
    assert sorted(path.name for path in (tmp_path / "p").iterdir()) == [
        "README.md",
        "policy.json",
        "policy.onnx",
        "policy.safetensors",
    ]


def test_scores_go_into_the_card_and_the_model_card(tmp_path):
    card = make_card()
    export_policy(tmp_path / "p", card, make_weights(card))
    policy, clips = load_policy(f"{tmp_path}/p"), from_clips([swaying_clip(40, name="a")])
    evaluation = evaluate(policy, clips, jobs=1)
    write_json(tmp_path / "p" / "evaluation.json", as_json(evaluation))
    outcomes = measure_robustness(policy, clips, 1, ())
    write_json(tmp_path / "p" / "robustness.json", robustness_as_json("small", "clips", outcomes))
    scores = take_in_scores(tmp_path / "p").scores
    assert scores["survival"] == round(evaluation.scores[0].survival, 6)
    assert scores["relative reward, unperturbed"] == 1.0
    assert read_policy(tmp_path / "p")[0].scores == scores
    text = (tmp_path / "p" / "README.md").read_text()
    assert "## Robustness" in text and "| test | 1 |" in text


def test_a_damaged_file_of_scores_is_named(tmp_path):
    card = make_card()
    export_policy(tmp_path / "p", card, make_weights(card))
    (tmp_path / "p" / "evaluation.json").write_text("{")
    with pytest.raises(InputFileError, match=r"evaluation\.json"):
        take_in_scores(tmp_path / "p")


def test_weights_of_another_size_are_refused_on_export(tmp_path):
    with pytest.raises(PolicyMismatchError):
        export_policy(tmp_path / "p", make_card(tau=3), make_weights(make_card(tau=1)))
    assert not (tmp_path / "p").exists()


def test_the_card_says_the_sizes_of_the_network(tmp_path):
    card = make_card(past=1)
    export_policy(tmp_path / "p", card, make_weights(card))
    assert json.loads((tmp_path / "p" / CARD_FILE).read_text())["network"] == [197 + 206 + 197, 24, 16, 35]
