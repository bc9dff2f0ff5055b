"""An FMU instance driven call by call through FMPy, with variables by name."""

from ctypes import byref
from itertools import count

import numpy as np
from fmpy import calloc, free
from fmpy.fmi2 import (
    FMU2Slave,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
    printLogMessage,
)
from fmpy.logging import addLoggerProxy

#: Logs of the living instances by name.
LOGS: dict[bytes, list] = {}


def _log(environment, instance, status, category, message):
    if instance in LOGS:
        LOGS[instance].append((status, category.decode(), message.decode()))
    else:
        printLogMessage(environment, instance, status, category, message)


# FMPy's proxy, which formats messages, keeps one logger for the whole process: it must never be freed.
CALLBACKS = fmi2CallbackFunctions()
CALLBACKS.logger = fmi2CallbackLoggerTYPE(_log)
CALLBACKS.allocateMemory = fmi2CallbackAllocateMemoryTYPE(calloc)
CALLBACKS.freeMemory = fmi2CallbackFreeMemoryTYPE(free)
addLoggerProxy(byref(CALLBACKS))


class Slave:
    """One instance. Collects its log messages as (status, category, text)."""

    _numbers = count()

    def __init__(self, unzipped: str, model_description):
        self.variables = {v.name: v for v in model_description.modelVariables}
        self.outputs = [v.name for v in model_description.modelVariables if v.causality == "output"]
        name = f"quadrotor {next(self._numbers)}"
        self.log: list[tuple[int, str, str]] = []
        LOGS[name.encode()] = self.log
        self.fmu = FMU2Slave(
            guid=model_description.guid,
            unzipDirectory=unzipped,
            modelIdentifier=model_description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        self.fmu.instantiate(callbacks=CALLBACKS)

    def initialize(self, start_values: dict | None = None, stop_time: float | None = None) -> "Slave":
        """Goes through initialization with these start values."""
        self.fmu.setupExperiment(startTime=0.0, stopTime=stop_time)
        self.set(start_values or {})
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        return self

    def set(self, values: dict) -> None:
        """Sets variables, one call each."""
        setters = {
            "Real": self.fmu.setReal,
            "Integer": self.fmu.setInteger,
            "Enumeration": self.fmu.setInteger,
            "Boolean": self.fmu.setBoolean,
        }
        for name, value in values.items():
            variable = self.variables[name]
            setters[variable.type]([variable.valueReference], [value])

    def get(self, *names: str) -> np.ndarray:
        """Reads numbers: real ones in one call, whole ones each for itself."""
        variables = [self.variables[name] for name in names]
        real = [variable.valueReference for variable in variables if variable.type == "Real"]
        reals = iter(self.fmu.getReal(real) if real else [])
        return np.array(
            [
                next(reals) if variable.type == "Real" else self.fmu.getInteger([variable.valueReference])[0]
                for variable in variables
            ]
        )

    def snapshot(self) -> np.ndarray:
        """All outputs."""
        return self.get(*self.outputs)

    def fly(self, start: float, stop: float, step: float) -> np.ndarray:
        """Steps from start to stop, adding up the time as importers do, and returns all outputs after
        each step."""
        recorded, time = [], start
        for _ in range(round((stop - start) / step)):
            self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=step)
            time += step
            recorded.append(self.snapshot())
        return np.array(recorded)

    def free(self) -> None:
        self.fmu.freeInstance()
        del LOGS[self.fmu.instanceName.encode()]
