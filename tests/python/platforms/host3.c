/* A host of FMI 3.0 co-simulation that knows no model and no XML: flies an FMU's library and prints what it sees as bits.
 *
 *   host3 LIBRARY TOKEN STEPS STEP REFERENCE:SIZE...
 *
 * STEP is in seconds; each REFERENCE is of an output of the type Float64 with SIZE elements. The types are written again from the
 * standard's text. */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
#define OPEN(path) ((void *)LoadLibraryA(path))
#define FIND(library, name) ((void *)GetProcAddress((HMODULE)(library), name))
#else
#include <dlfcn.h>
#define OPEN(path) dlopen(path, RTLD_NOW | RTLD_LOCAL)
#define FIND(library, name) dlsym(library, name)
#endif

typedef void *Instance;
typedef uint32_t Reference;
typedef void (*Log)(void *, int, const char *, const char *);

static void log_message(void *environment, int status, const char *category, const char *message) {
    (void)environment;
    printf("log %d %s: %s\n", status, category, message);
}

static void *library;
static void *function(const char *name) {
    void *found = FIND(library, name);
    if (!found) {
        printf("no function %s\n", name);
        exit(2);
    }
    return found;
}

static void expect_ok(const char *call, int status) {
    if (status != 0) {
        printf("%s returned %d\n", call, status);
        exit(1);
    }
}
#define CALL(name, types, ...) expect_ok(#name, ((int(*) types)function(#name))(__VA_ARGS__))

static void print_outputs(Instance instance, const Reference *references, size_t count, double *values, size_t size) {
    size_t i;
    CALL(fmi3GetFloat64, (Instance, const Reference *, size_t, double *, size_t), instance, references, count, values, size);
    for (i = 0; i < size; ++i) {
        uint64_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        printf("%016llx%c", (unsigned long long)bits, i + 1 < size ? ' ' : '\n');
    }
}

int main(int argc, char **argv) {
    size_t count = argc > 5 ? (size_t)argc - 5 : 0, size = 0, i;
    Instance instance;
    Reference *references;
    double *values, length;
    long steps, step;

    if (count == 0) {
        return 64;
    }
    library = OPEN(argv[1]);
    if (!library) {
        printf("cannot load %s\n", argv[1]);
        return 2;
    }
    steps = atol(argv[3]);
    length = atof(argv[4]);
    references = malloc(count * sizeof *references);
    for (i = 0; i < count; ++i) {
        char *end;
        references[i] = (Reference)strtoul(argv[5 + i], &end, 10);
        size += *end == ':' ? strtoul(end + 1, NULL, 10) : 1;
    }
    values = malloc(size * sizeof *values);

    printf("FMI %s\n", ((const char *(*)(void))function("fmi3GetVersion"))());
    instance = ((Instance(*)(const char *, const char *, const char *, bool, bool, bool, bool, const Reference *, size_t, void *, Log, void *))function(
        "fmi3InstantiateCoSimulation"))("flight", argv[2], NULL, false, true, false, false, NULL, 0, NULL, log_message, NULL);
    if (!instance) {
        printf("not instantiated\n");
        return 1;
    }
    CALL(fmi3EnterInitializationMode, (Instance, bool, double, double, bool, double), instance, false, 0.0, 0.0, true, (double)steps * length);
    CALL(fmi3ExitInitializationMode, (Instance), instance);
    print_outputs(instance, references, count, values, size);
    for (step = 0; step < steps; ++step) {
        bool event = false, terminate = false, early = false;
        double last = 0.0;
        CALL(fmi3DoStep, (Instance, double, double, bool, bool *, bool *, bool *, double *), instance, (double)step * length, length, true, &event,
             &terminate, &early, &last);
        if (terminate || early) {
            printf("ended at %g\n", last);
            return 1;
        }
        print_outputs(instance, references, count, values, size);
    }
    CALL(fmi3Terminate, (Instance), instance);
    ((void (*)(Instance))function("fmi3FreeInstance"))(instance);
    printf("end\n");
    return 0;
}
