/* A rigid body over flat ground, driven by a thrust and three torques: axes east, north, up and forward, left, up; angles in degrees.
 *
 * It is compiled against the headers of the standard, and shares nothing with the vehicle that it is flown by. FAULT makes it fail
 * from 3 s of simulation time on. ENVIRONMENT says what it hands to the logger: what it was given, a pointer of its own, or none.
 * Without GROUND nothing carries it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fmi2Functions.h"

#define SEGFAULT 1
#define ERROR 2
#define HANG 3
#define NOT_A_NUMBER 4
#define EXIT 5
#define ABORT 6
#define START 7
#ifndef FAULT
#define FAULT 0
#endif

#define GIVEN 0
#define OWN 1
#define NONE_AT_ALL 2
#ifndef ENVIRONMENT
#define ENVIRONMENT GIVEN
#endif
#ifndef GROUND
#define GROUND 1
#endif

enum { MASS, JX, JY, JZ, START_EAST, START_NORTH, START_YAW, THRUST, TX, TY, TZ, EAST, NORTH, UP, VE, VN, VU, ROLL, PITCH, YAW, P, Q, R, COUNT };

static int *volatile nowhere;
static const double DEGREE = 3.14159265358979323846 / 180.0;

typedef struct {
    double value[COUNT];
    double attitude[4]; /* body into world, scalar first */
    double place[3], velocity[3], rate[3];
    const fmi2CallbackFunctions *callbacks;
    char name[64];
} Body;

static void *environment(const Body *body)
{
    static char own[256];
    memset(own, 0xff, sizeof own);
    return ENVIRONMENT == OWN ? own : ENVIRONMENT == NONE_AT_ALL ? NULL : body->callbacks->componentEnvironment;
}

static void show(Body *body)
{
    const double *q = body->attitude;
    for (int axis = 0; axis < 3; axis++) {
        body->value[EAST + axis] = body->place[axis];
        body->value[VE + axis] = body->velocity[axis];
        body->value[P + axis] = body->rate[axis] / DEGREE;
    }
    double sine = 2 * (q[0] * q[2] - q[3] * q[1]);
    body->value[ROLL] = atan2(2 * (q[0] * q[1] + q[2] * q[3]), 1 - 2 * (q[1] * q[1] + q[2] * q[2])) / DEGREE;
    body->value[PITCH] = asin(fmax(-1, fmin(1, sine))) / DEGREE;
    body->value[YAW] = atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3])) / DEGREE;
}

static void turn(double *q, const double *rate, double h)
{
    double p = rate[0], s = rate[1], r = rate[2];
    double d[4] = { -q[1] * p - q[2] * s - q[3] * r, q[0] * p + q[2] * r - q[3] * s, q[0] * s - q[1] * r + q[3] * p, q[0] * r + q[1] * s - q[2] * p };
    double norm = 0;
    for (int i = 0; i < 4; i++) {
        q[i] += h / 2 * d[i];
        norm += q[i] * q[i];
    }
    for (int i = 0; i < 4; i++)
        q[i] /= sqrt(norm);
}

static void move(Body *body, double h)
{
    const double *v = body->value;
    double *q = body->attitude, *w = body->rate;
    double up[3] = { 2 * (q[1] * q[3] + q[0] * q[2]), 2 * (q[2] * q[3] - q[0] * q[1]), 1 - 2 * (q[1] * q[1] + q[2] * q[2]) };
    double torque[3] = { v[TX] - (v[JZ] - v[JY]) * w[1] * w[2], v[TY] - (v[JX] - v[JZ]) * w[2] * w[0], v[TZ] - (v[JY] - v[JX]) * w[0] * w[1] };
    for (int axis = 0; axis < 3; axis++) {
        body->velocity[axis] += h * (v[THRUST] * up[axis] / v[MASS] - (axis == 2 ? 9.81 : 0));
        w[axis] += h * torque[axis] / v[JX + axis];
    }
    if (GROUND && body->place[2] <= 0 && body->velocity[2] <= 0) {
        /* It stands as it was put down, level. */
        double yaw = atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
        memset(body->velocity, 0, sizeof body->velocity);
        memset(w, 0, sizeof body->rate);
        body->place[2] = 0;
        q[0] = cos(yaw / 2), q[1] = 0, q[2] = 0, q[3] = sin(yaw / 2);
        return;
    }
    for (int axis = 0; axis < 3; axis++)
        body->place[axis] += h * body->velocity[axis];
    turn(q, w, h);
}

static fmi2Status fail(Body *body, double time)
{
    if (FAULT == 0 || time < 3.0)
        return fmi2OK;
    body->callbacks->logger(environment(body), body->name, fmi2Warning, "logStatusWarning", "at %.3f s: %s %d", time, "fault", FAULT);
    switch (FAULT) {
    case SEGFAULT:
        *nowhere = 1;
        break;
    case ERROR:
        return fmi2Error;
    case HANG:
        for (;;)
            pause();
    case NOT_A_NUMBER:
        body->value[NORTH] = NAN;
        break;
    case EXIT:
        printf("leaving, %s", "without a line's end");
        exit(7);
    case ABORT:
        abort();
    }
    return fmi2OK;
}

const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources, const fmi2CallbackFunctions *callbacks, fmi2Boolean visible, fmi2Boolean logging)
{
    (void)type, (void)resources, (void)visible, (void)logging;
    Body *body = callbacks->allocateMemory(1, sizeof(Body));
    if (!body || strcmp(guid, "{body}"))
        return NULL;
    if (FAULT == START)
        *nowhere = 1;
    body->callbacks = callbacks;
    snprintf(body->name, sizeof body->name, "%s", name);
    body->value[MASS] = 1, body->value[JX] = body->value[JY] = body->value[JZ] = 0.01;
    body->attitude[0] = 1;
    return body;
}

void fmi2FreeInstance(fmi2Component c) { ((Body *)c)->callbacks->freeMemory(c); }
fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count, const fmi2String categories[]) { (void)c, (void)on, (void)count, (void)categories; return fmi2OK; }
fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean defined, fmi2Real tolerance, fmi2Real start, fmi2Boolean ends, fmi2Real stop) { (void)c, (void)defined, (void)tolerance, (void)start, (void)ends, (void)stop; return fmi2OK; }
fmi2Status fmi2EnterInitializationMode(fmi2Component c) { (void)c; return fmi2OK; }

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    Body *body = c;
    double yaw = body->value[START_YAW] * DEGREE;
    body->place[0] = body->value[START_EAST], body->place[1] = body->value[START_NORTH];
    body->attitude[0] = cos(yaw / 2), body->attitude[3] = sin(yaw / 2);
    show(body);
    body->callbacks->logger(environment(body), body->name, fmi2Warning, "logAll", "%s has a mass of %.2f kg, %d%%", body->name, body->value[MASS], 100);
    return fmi2OK;
}

fmi2Status fmi2Terminate(fmi2Component c) { (void)c; printf("terminated\n"); return fmi2OK; }
fmi2Status fmi2Reset(fmi2Component c) { (void)c; return fmi2Error; }

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t count, fmi2Real value[])
{
    for (size_t i = 0; i < count; i++)
        value[i] = ((Body *)c)->value[vr[i]];
    return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t count, const fmi2Real value[])
{
    for (size_t i = 0; i < count; i++)
        ((Body *)c)->value[vr[i]] = value[i];
    return fmi2OK;
}

#define NONE(NAME, TYPE) fmi2Status NAME(fmi2Component c, const fmi2ValueReference vr[], size_t count, TYPE value[]) { (void)c, (void)vr, (void)count, (void)value; return fmi2Error; }
NONE(fmi2GetInteger, fmi2Integer)
NONE(fmi2GetBoolean, fmi2Boolean)
NONE(fmi2GetString, fmi2String)
NONE(fmi2SetInteger, const fmi2Integer)
NONE(fmi2SetBoolean, const fmi2Boolean)
NONE(fmi2SetString, const fmi2String)

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean no_way_back)
{
    Body *body = c;
    (void)no_way_back;
    for (int i = 0; i < 10; i++)
        move(body, step / 10);
    show(body);
    return fail(body, time);
}
