/* A co-simulation master in the manner of fmusim, with nothing but the headers of the standard.
 *
 *   master LIBRARY TOKEN STOP_TIME STEPS FIRST LENGTH [FIRST LENGTH ...] [-- REFERENCE VALUES ...]
 *
 * prints, for each communication point, the elements of the Float64 variables with the references FIRST, LENGTH of each, as
 * hexadecimal numbers. What follows "--" is set before initialization: one Float64 variable with its elements. Half way the state is
 * saved as bytes, a step is taken, and the run continues from the bytes, as a master does that rejects a step.
 */

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi3FunctionTypes.h"

#define MOST 64

static void *library;

static void *symbol(const char *name) {
    void *found = dlsym(library, name);
    if (!found) {
        fprintf(stderr, "%s is missing\n", name);
        exit(2);
    }
    return found;
}

#define FUNCTION(name) name##TYPE *name = (name##TYPE *)symbol(#name)
#define DONE(call)                                                                                                     \
    do {                                                                                                               \
        if ((call) != fmi3OK) {                                                                                        \
            fprintf(stderr, "%s failed\n", #call);                                                                     \
            exit(3);                                                                                                   \
        }                                                                                                              \
    } while (0)

static void logged(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category, fmi3String message) {
    (void)environment;
    fprintf(stderr, "%d %s: %s\n", status, category, message);
}

int main(int count, char *arguments[]) {
    if (count < 7) {
        fprintf(stderr, "too few arguments\n");
        return 1;
    }
    library = dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        return 1;
    }
    const double stop = atof(arguments[3]);
    const int steps = atoi(arguments[4]);
    fmi3ValueReference references[MOST];
    size_t variables = 0, elements = 0;
    int next = 5;
    for (; next + 1 < count && strcmp(arguments[next], "--") != 0; next += 2) {
        references[variables++] = (fmi3ValueReference)atoi(arguments[next]);
        elements += (size_t)atoi(arguments[next + 1]);
    }
    if (variables > MOST || elements > MOST) {
        fprintf(stderr, "too many variables\n");
        return 1;
    }

    FUNCTION(fmi3GetVersion);
    FUNCTION(fmi3InstantiateCoSimulation);
    FUNCTION(fmi3EnterInitializationMode);
    FUNCTION(fmi3ExitInitializationMode);
    FUNCTION(fmi3SetFloat64);
    FUNCTION(fmi3GetFloat64);
    FUNCTION(fmi3DoStep);
    FUNCTION(fmi3GetFMUState);
    FUNCTION(fmi3SetFMUState);
    FUNCTION(fmi3FreeFMUState);
    FUNCTION(fmi3SerializedFMUStateSize);
    FUNCTION(fmi3SerializeFMUState);
    FUNCTION(fmi3DeserializeFMUState);
    FUNCTION(fmi3Terminate);
    FUNCTION(fmi3FreeInstance);

    if (strncmp(fmi3GetVersion(), "3.", 2) != 0) {
        fprintf(stderr, "version %s\n", fmi3GetVersion());
        return 1;
    }
    fmi3Instance instance = fmi3InstantiateCoSimulation("master", arguments[2], NULL, fmi3False, fmi3True, fmi3False,
                                                        fmi3False, NULL, 0, NULL, logged, NULL);
    if (!instance) {
        return 1;
    }
    if (next + 1 < count) {
        const fmi3ValueReference reference = (fmi3ValueReference)atoi(arguments[next + 1]);
        double values[MOST];
        size_t length = 0;
        for (int i = next + 2; i < count && length < MOST; i++) {
            values[length++] = atof(arguments[i]);
        }
        DONE(fmi3SetFloat64(instance, &reference, 1, values, length));
    }
    DONE(fmi3EnterInitializationMode(instance, fmi3False, 0.0, 0.0, fmi3True, stop));
    DONE(fmi3ExitInitializationMode(instance));

    const double step = stop / steps;
    fmi3Boolean event = fmi3False, terminate = fmi3False, early = fmi3False;
    double reached = 0.0, values[MOST];
    for (int i = 0; i <= steps; i++) {
        DONE(fmi3GetFloat64(instance, references, variables, values, elements));
        printf("%a", reached);
        for (size_t k = 0; k < elements; k++) {
            printf(" %a", values[k]);
        }
        printf("\n");
        if (i == steps) {
            break;
        }
        if (i == steps / 2) {
            fmi3FMUState state = NULL;
            size_t size = 0;
            DONE(fmi3GetFMUState(instance, &state));
            DONE(fmi3SerializedFMUStateSize(instance, state, &size));
            fmi3Byte *bytes = malloc(size);
            DONE(fmi3SerializeFMUState(instance, state, bytes, size));
            DONE(fmi3FreeFMUState(instance, &state));
            DONE(fmi3DoStep(instance, i * step, step, fmi3False, &event, &terminate, &early, &reached));
            DONE(fmi3DeserializeFMUState(instance, bytes, size, &state));
            DONE(fmi3SetFMUState(instance, state));
            DONE(fmi3FreeFMUState(instance, &state));
            free(bytes);
        }
        DONE(fmi3DoStep(instance, i * step, step, fmi3True, &event, &terminate, &early, &reached));
        if (event || terminate || early) {
            fprintf(stderr, "an event, an end or an early return at %g\n", reached);
            return 3;
        }
    }
    DONE(fmi3Terminate(instance));
    fmi3FreeInstance(instance);
    return 0;
}
