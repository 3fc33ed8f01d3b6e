/* 10 000 contacts in a loop of OpenMP, and the same one by one. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stickslip.h"

enum { COUNT = 10000, STEPS = 5, SHARE = 100 };

static const char *BALL =
    "{\"profile\": {\"type\": \"sphere\", \"radius\": 0.01},"
    " \"material\": {\"effective\": {\"e_star\": 1.15e11, \"g_star\": 8.5e10}},"
    " \"friction\": 0.3, \"preload\": {\"normal_force\": 10.0}}";

static ss_contact *contacts[COUNT];
static double normal[COUNT], displacement[COUNT], forces[2 * COUNT], alone[2 * COUNT];

static void check(int code) {
    if (code != SS_OK) {
        fprintf(stderr, "%s\n", ss_last_error());
        exit(1);
    }
}

/* The end of step `step`, of which each contact has another. */
static void targets(int step) {
    for (int i = 0; i < COUNT; ++i) {
        normal[i] = 8.0 + 4e-4 * ((i * 7 + step * 13) % COUNT) / 2.0;
        displacement[i] = 2e-8 * ((i * 31 + step * 17) % 101 - 50) / 50.0;
    }
}

static void all(int is_parallel, double *result) {
    ss_contact *first = NULL;
    check(ss_contact_new(BALL, &first));
    for (int i = 0; i < COUNT; ++i)
        check(ss_copy(first, &contacts[i]));
    for (int step = 0; step < STEPS; ++step) {
        targets(step);
#pragma omp parallel for schedule(static) if (is_parallel)
        for (int i = 0; i < COUNT; i += SHARE)
            check(ss_step_many(contacts + i, SHARE, SS_NORMAL_FORCE, normal + i, displacement + i, result + 2 * i, NULL));
    }
    for (int i = 0; i < COUNT; ++i)
        check(ss_free(contacts[i]));
    check(ss_free(first));
}

int main(void) {
    all(1, forces);
    all(0, alone);
    if (memcmp(forces, alone, sizeof forces) != 0) {
        fprintf(stderr, "the number of threads changes the forces\n");
        return 1;
    }
    printf("many: ok, %d contacts\n", COUNT);
    return 0;
}
