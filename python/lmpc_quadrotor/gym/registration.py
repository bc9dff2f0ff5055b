"""The names under which Gymnasium knows the environments."""

import gymnasium

_PACKAGE = "lmpc_quadrotor.gym"


def register() -> None:
    """Registers the environments; again has no effect."""
    for name in ("Hover", "Track"):
        identifier = f"lmpc_quadrotor/{name}-v0"
        if identifier not in gymnasium.registry:
            gymnasium.register(
                id=identifier,
                entry_point=f"{_PACKAGE}.environment:QuadrotorEnv",
                vector_entry_point=f"{_PACKAGE}.vector:QuadrotorVectorEnv",
                kwargs={"task": name.lower()},
                # Episodes are cut off by the environments themselves, single and vector ones alike.
                order_enforce=True,
            )


register()
