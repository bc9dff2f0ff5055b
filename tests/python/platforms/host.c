/* A host of FMI 2.0 co-simulation that knows no model and no XML: flies an FMU's library and prints what it sees as bits.
 *
 *   host LIBRARY IDENTIFIER GUID STEPS STEP PARAMETER HOSTILE REFERENCE...
 *
 * STEP is in seconds; PARAMETER is the value reference of a parameter that no value of 1e300 fits; the REFERENCEs are of real outputs.
 * With HOSTILE = 1, each call is made in a floating-point environment of the host's own, which must be the same afterwards.
 * The types are written again from the standard's text. */
#include <stdarg.h>
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

typedef void *Component;
typedef void *State;
typedef unsigned int Reference;

typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*step_finished)(void *, int);
    void *environment;
} Callbacks;

static void logger(void *environment, const char *instance, int status, const char *category, const char *format, ...) {
    va_list arguments;
    (void)environment;
    printf("log %s %d %s: ", instance, status, category);
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
    printf("\n");
}

/* Tiny numbers are flushed to zero, results are rounded towards zero, invalid operations and divisions by zero trap. */
#if defined(__x86_64__)
typedef uint32_t Environment;
static const Environment usual = 0x1f80, hostile = (0x1f80 | 0x8040 | 0x6000) & ~0x0280u;
static Environment get(void) { Environment e; __asm__ volatile("stmxcsr %0" : "=m"(e) : : "memory"); return e; }
static void set(Environment e) { __asm__ volatile("ldmxcsr %0" : : "m"(e) : "memory"); }
#elif defined(__aarch64__)
typedef uint64_t Environment;
static const Environment usual = 0, hostile = 1u << 24 | 3u << 22;
static Environment get(void) { Environment e; __asm__ volatile("mrs %0, fpcr" : "=r"(e) : : "memory"); return e; }
static void set(Environment e) { __asm__ volatile("msr fpcr, %0" : : "r"(e) : "memory"); }
#endif

static Environment during;
static void enter(void) { set(during); }
static void leave(const char *call) {
    Environment after = get();
    set(usual);
    if (after != during) {
        printf("%s left the environment %llx\n", call, (unsigned long long)after);
        exit(3);
    }
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

static void expect(const char *call, int status, int expected) {
    if (status != expected) {
        printf("%s returned %d\n", call, status);
        exit(1);
    }
}
#define CALL(expected, name, types, ...) \
    do { \
        int(*call) types = (int(*) types)function(#name); \
        int status; \
        enter(); \
        status = call(__VA_ARGS__); \
        leave(#name); \
        expect(#name, status, expected); \
    } while (0)

static void print_outputs(Component component, const Reference *references, size_t count, double *values) {
    size_t i;
    CALL(0, fmi2GetReal, (Component, const Reference *, size_t, double *), component, references, count, values);
    for (i = 0; i < count; ++i) {
        uint64_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        printf("%016llx%c", (unsigned long long)bits, i + 1 < count ? ' ' : '\n');
    }
}

int main(int argc, char **argv) {
    const Callbacks callbacks = {logger, calloc, free, NULL, NULL};
    Component component;
    State state = NULL;
    size_t count = argc > 8 ? (size_t)argc - 8 : 0, size = 0, i;
    long steps, step;
    double *points, *values, length, huge = 1e300;
    Reference *references, parameter;
    unsigned char *bytes;
    uint64_t hash = 14695981039346656037ull;

    if (count == 0) {
        return 64;
    }
    during = atoi(argv[7]) ? hostile : usual;
    library = OPEN(argv[1]);
    if (!library) {
        printf("cannot load %s\n", argv[1]);
        return 2;
    }
    steps = atol(argv[4]);
    length = atof(argv[5]);
    parameter = (Reference)atoi(argv[6]);
    references = malloc(count * sizeof *references);
    values = malloc(count * sizeof *values);
    /* Before the environment changes: they must be the same numbers in every one. */
    points = malloc((size_t)(steps + 1) * sizeof *points);
    for (step = 0; step <= steps; ++step) {
        points[step] = (double)step * length;
    }
    for (i = 0; i < count; ++i) {
        references[i] = (Reference)atoi(argv[8 + i]);
    }

    printf("FMI %s, %s\n", ((const char *(*)(void))function("fmi2GetVersion"))(),
           ((const char *(*)(void))function("fmi2GetTypesPlatform"))());
    {
        Component (*instantiate)(const char *, int, const char *, const char *, const Callbacks *, int, int) =
            (Component(*)(const char *, int, const char *, const char *, const Callbacks *, int, int))function("fmi2Instantiate");
        enter();
        component = instantiate(argv[2], 1, argv[3], NULL, &callbacks, 0, 1);
        leave("fmi2Instantiate");
    }
    if (!component) {
        printf("not instantiated\n");
        return 1;
    }
    /* Refused, with a message of several arguments. */
    CALL(3, fmi2SetReal, (Component, const Reference *, size_t, const double *), component, &parameter, 1, &huge);
    CALL(0, fmi2Reset, (Component), component);
    CALL(0, fmi2SetupExperiment, (Component, int, double, double, int, double), component, 0, 0.0, 0.0, 1, points[steps]);
    CALL(0, fmi2EnterInitializationMode, (Component), component);
    CALL(0, fmi2ExitInitializationMode, (Component), component);
    print_outputs(component, references, count, values);
    for (step = 0; step < steps; ++step) {
        if (step == steps / 2) {
            /* A saved state has the same bytes everywhere, so that it can be carried from one platform to another. */
            CALL(0, fmi2GetFMUstate, (Component, State *), component, &state);
            CALL(0, fmi2SerializedFMUstateSize, (Component, State, size_t *), component, state, &size);
            bytes = malloc(size);
            CALL(0, fmi2SerializeFMUstate, (Component, State, unsigned char *, size_t), component, state, bytes, size);
            CALL(0, fmi2FreeFMUstate, (Component, State *), component, &state);
            for (i = 0; i < size; ++i) {
                hash = (hash ^ bytes[i]) * 1099511628211ull;
            }
            printf("state of %llu bytes, %016llx\n", (unsigned long long)size, (unsigned long long)hash);
            CALL(0, fmi2DeSerializeFMUstate, (Component, const unsigned char *, size_t, State *), component, bytes, size, &state);
            CALL(0, fmi2SetFMUstate, (Component, State), component, state);
            CALL(0, fmi2FreeFMUstate, (Component, State *), component, &state);
            free(bytes);
        }
        CALL(0, fmi2DoStep, (Component, double, double, int), component, points[step], length, 1);
        print_outputs(component, references, count, values);
    }
    CALL(0, fmi2Terminate, (Component), component);
    ((void (*)(Component))function("fmi2FreeInstance"))(component);
    printf("end\n");
    return 0;
}
