"""The kinds of controllers, measurement noise, and what the outputs tell of limits, through FMPy."""

import numpy as np
import pytest
from fmpy import simulate_fmu

import flights

KINDS = {"lmpc": 1, "ssmpc": 2, "dlqr": 3}
LOOPS = ("altitude", "position", "attitude")


def fly(unzipped, model_description, stop_time: float = 20.0, **start_values) -> np.ndarray:
    return simulate_fmu(
        unzipped,
        stop_time=stop_time,
        output_interval=0.05,
        start_values={name.replace("__", "."): value for name, value in start_values.items()},
        model_description=model_description,
    )


def test_the_description_names_the_kinds_and_the_outcomes(model_description):
    variables = {variable.name: variable for variable in model_description.modelVariables}
    kind = variables["controller.kind"]
    assert kind.type == "Enumeration" and kind.start == "1" and kind.variability == "fixed"
    assert [(item.name, int(item.value)) for item in kind.declaredType.items] == list(KINDS.items())
    for loop in LOOPS:
        status = variables[f"controller.{loop}.status"]
        assert [item.name for item in status.declaredType.items] == ["optimal", "relaxed", "iteration_limit", "held"]
        for figure in ("active_constraints", "iterations"):
            assert variables[f"controller.{loop}.{figure}"].type == "Integer"


def test_learned_mass_and_drag_are_shown(unzipped, model_description):
    goal = dict(reference__shaping=False, reference__position__x=30.0, controller__mass_factor=0.75)
    drag = dict(airframe__drag__x=0.3, airframe__drag__y=0.2)
    result = fly(unzipped, model_description, **goal, **drag)
    mass_kg = next(float(variable.start) for variable in model_description.modelVariables if variable.name == "airframe.mass")
    assert result["controller.believed_mass"][0] == pytest.approx(0.75 * mass_kg, rel=1e-12)
    assert result["controller.believed_mass"][-1] == pytest.approx(mass_kg, rel=0.02)
    assert result["controller.believed_drag.x"][-1] == pytest.approx(0.3, rel=0.1)
    configured = fly(unzipped, model_description, **goal, **drag, controller__learning=False)
    assert np.ptp(configured["controller.believed_mass"]) == np.ptp(configured["controller.believed_drag.y"]) == 0.0
    assert configured["controller.believed_mass"][0] == pytest.approx(0.75 * mass_kg, rel=1e-12)
    assert configured["controller.believed_drag.y"][0] == 0.2


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
@pytest.mark.parametrize("shaping", [True, False], ids=["shaped", "raw"])
def test_every_kind_flies_to_the_goal(unzipped, model_description, kind, shaping):
    result = fly(unzipped, model_description, controller__kind=kind, reference__shaping=shaping)
    for axis, goal in zip("xyz", flights.GOAL):
        assert result[f"position.{axis}"][-1] == pytest.approx(goal, abs=1e-3)
        beyond = (result[f"position.{axis}"] / goal).max() - 1.0
        assert beyond < (0.005 if shaping else 0.04)
    for loop in LOOPS:
        assert set(np.unique(result[f"controller.{loop}.status"])) <= {1, 2}


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
def test_limits_of_thrust_and_tilt_bind_on_a_raw_step_and_not_in_hover(unzipped, model_description, kind):
    result = fly(
        unzipped, model_description, 30.0, controller__kind=kind, controller__governor=False, reference__shaping=False,
        reference__position__x=20.0, reference__position__y=0.0, reference__position__z=-8.0,
    )  # fmt: skip
    for loop in ("altitude", "position"):
        active = result[f"controller.{loop}.active_constraints"]
        assert active.max() > 0 and active[-1] == 0
        assert (result[f"controller.{loop}.iterations"].max() > 0) == (kind != KINDS["dlqr"])


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
def test_limits_of_the_rotors_bind_far_from_upright_and_not_in_hover(unzipped, model_description, kind):
    """What is commanded on the way keeps within the torques; an attitude out of the air does not. A weakness of the regulator, whose
    torques are cut off without its knowledge: it keeps swinging, by half a metre, where the controllers that know the limits rest."""
    result = fly(
        unzipped, model_description, 20.0, controller__kind=kind, initial__attitude__phi=2.0, initial__position__z=-50.0,
        reference__position__x=0.0, reference__position__y=0.0, reference__position__z=-50.0,
    )  # fmt: skip
    active = result["controller.attitude.active_constraints"]
    off = np.abs(result["position.y"][result["time"] > 15.0]).max()
    assert active.max() > 0
    if kind == KINDS["dlqr"]:
        assert off < 1.0
    else:
        assert active[-1] == 0 and off < 0.01
    assert (result["controller.attitude.iterations"].max() > 0) == (kind != KINDS["dlqr"])


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
@pytest.mark.parametrize("output_feedback", [False, True], ids=["full state", "outputs"])
def test_noise_is_lived_with(unzipped, model_description, kind, output_feedback):
    result = fly(
        unzipped, model_description, 40.0, controller__kind=kind, sensor__output_feedback=output_feedback,
        sensor__position_noise=0.02, sensor__attitude_noise=0.003, sensor__velocity_noise=0.0 if output_feedback else 0.02,
        sensor__seed=7,
    )  # fmt: skip
    late = result["time"] > 15.0
    for axis, goal in zip("xyz", flights.GOAL):
        error = result[f"position.{axis}"][late] - goal
        assert 1e-4 < np.sqrt(np.mean(error**2)) < 0.1


def test_noise_is_repeatable_and_depends_on_the_seed(unzipped, model_description):
    def noisy(seed: int) -> np.ndarray:
        return fly(unzipped, model_description, 3.0, sensor__position_noise=0.05, sensor__seed=seed)["position.x"]

    assert (noisy(1) == noisy(1)).all()
    assert (noisy(1) != noisy(2)).any()


@pytest.mark.parametrize("kind", [-1, 0, 4])
def test_an_unknown_kind_is_refused_by_name(slave, kind):
    instance = slave()
    with pytest.raises(Exception, match="fmi2SetInteger"):
        instance.set({"controller.kind": kind})
    assert any("controller.kind" in text for _, _, text in instance.log)
