"""Arm, take off, go somewhere, land: what every client does first."""

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from client import PX4_OFFBOARD, near


def test_from_the_ground_to_a_place_and_back(start, connect):
    client = connect(start())
    client.take_off()
    beat = client.wait("HEARTBEAT", lambda beat: beat.custom_mode == (4 << 16 | 3 << 24))
    assert beat.autopilot == mavlink.MAV_AUTOPILOT_PX4 and beat.type == mavlink.MAV_TYPE_QUADROTOR
    assert client.wait("EXTENDED_SYS_STATE").landed_state == mavlink.MAV_LANDED_STATE_IN_AIR

    goal = (5.0, 5.0, -10.0)
    client.go(lambda: client.position(goal))
    client.stream(lambda: client.position(goal), near(goal))
    assert client.wait("HEARTBEAT").custom_mode == PX4_OFFBOARD[1] << 16
    client.land()
    state = client.wait("EXTENDED_SYS_STATE", lambda state: state.landed_state == mavlink.MAV_LANDED_STATE_ON_GROUND)
    assert state is not None
