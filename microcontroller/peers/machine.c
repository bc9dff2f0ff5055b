/* Start of the emulated Cortex-M4F, and its system timer, which goes by instructions under -icount shift=6. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "peer.h"

#define REGISTER(address) (*(volatile uint32_t *)(address))
#define TIMER_CONTROL REGISTER(0xE000E010)
#define TIMER_RELOAD REGISTER(0xE000E014)
#define TIMER_VALUE REGISTER(0xE000E018)
#define COPROCESSORS REGISTER(0xE000ED88)
#define TIMER_RANGE 0x1000000u

extern char top_of_stack, first_cleared, last_cleared;
int main(void);
void initialise_monitor_handles(void);
void __libc_init_array(void);
void *__dso_handle;

void _init(void) {}
void _fini(void) {}

static volatile uint32_t rounds;

void reset(void)
{
    COPROCESSORS |= 0xFu << 20; /* the floating-point unit */
    __asm volatile("dsb\n isb");
    for (char *byte = &first_cleared; byte < &last_cleared; byte++) *byte = 0;
    TIMER_RELOAD = TIMER_RANGE - 1;
    TIMER_VALUE = 0;
    TIMER_CONTROL = 7; /* on, with interrupt, by the processor's clock */
    initialise_monitor_handles();
    __libc_init_array();
    exit(main());
}

static void fault(void) { _Exit(1); }

static void timer(void) { rounds++; }

__attribute__((section(".vectors"), used)) void *const vectors[16] = {
    &top_of_stack, (void *)reset, (void *)fault, (void *)fault, (void *)fault, (void *)fault, (void *)fault,
    [15] = (void *)timer,
};

unsigned long long instructions(void)
{
    uint32_t before, value;
    do {
        before = rounds;
        value = TIMER_VALUE;
    } while (before != rounds);
    /* It counts down, 40 ns a tick; an instruction is 64 ns. */
    return ((unsigned long long)before * TIMER_RANGE + (TIMER_RANGE - 1 - value)) * 5 / 8;
}

static int by_size(const void *one, const void *other)
{
    unsigned long long a = *(const unsigned long long *)one, b = *(const unsigned long long *)other;
    return a < b ? -1 : a > b;
}

void report(unsigned long long *counts, int steps, int most_iterations, int failures)
{
    qsort(counts, steps, sizeof *counts, by_size);
    printf("{\"median\": %lu, \"p99\": %lu, \"worst\": %lu, \"iterations\": %d, \"failures\": %d}\n",
           (unsigned long)counts[(steps - 1) / 2], (unsigned long)counts[(steps - 1) * 99 / 100],
           (unsigned long)counts[steps - 1], most_iterations, failures);
}
