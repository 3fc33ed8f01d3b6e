/* A steel ball on a steel plane: a loop, a trial that is taken back, a restart. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stickslip.h"

static const char *BALL =
    "{\"profile\": {\"type\": \"sphere\", \"radius\": 0.01},"
    " \"material\": {\"bodies\": [{\"youngs_modulus\": 2.1e11, \"poisson_ratio\": 0.3},"
    " {\"youngs_modulus\": 2.1e11, \"poisson_ratio\": 0.3}]},"
    " \"friction\": 0.3, \"preload\": {\"normal_force\": 10.0}}";

static void check(int code) {
    if (code != SS_OK) {
        fprintf(stderr, "%s\n", ss_last_error());
        exit(1);
    }
}

static void expect(int holds, const char *what) {
    if (!holds) {
        fprintf(stderr, "not so: %s\n", what);
        exit(1);
    }
}

int main(void) {
    ss_contact *ball = NULL, *copy = NULL;
    ss_contact_state state;
    double forces[2], first[2];
    check(ss_contact_new(BALL, &ball));
    check(ss_state(ball, &state));
    /* Cattaneo (1938): half-way to gross slip the force is mu F_N (1 - (1/2)^(3/2)). u_max is mu times the ratio of
     * the reduced moduli times d. */
    double moduli = (2.0 - 0.3) / (2.0 * (1.0 - 0.3)); /* Of bodies of one material. */
    double full = 0.3 * moduli * state.indentation, half = 0.5 * full;
    check(ss_step(ball, SS_CONSTANT_LOAD, 0.0, &half, forces));
    expect(fabs(forces[1] / (3.0 * (1.0 - pow(0.5, 1.5))) - 1.0) < 1e-12, "the force of Cattaneo");

    /* An iteration: trials from the committed state, of which the last is kept. */
    double there = 0.8 * full, back = 0.2 * full;
    check(ss_trial(ball, SS_NORMAL_FORCE, 8.0, &there, forces));
    check(ss_trial(ball, SS_CONSTANT_LOAD, 0.0, &back, first));
    check(ss_commit(ball));
    check(ss_state(ball, &state));
    expect(state.force[0] == first[1] && state.displacement[0] == back, "the last trial is committed");

    /* A restart: the same bits. */
    size_t length = 0;
    check(ss_pack(ball, NULL, 0, &length));
    void *bytes = malloc(length);
    expect(bytes != NULL, "there is memory");
    check(ss_pack(ball, bytes, length, &length));
    check(ss_contact_new(BALL, &copy));
    check(ss_unpack(copy, bytes, length));
    free(bytes);
    check(ss_step(ball, SS_CONSTANT_LOAD, 0.0, &there, first));
    check(ss_step(copy, SS_CONSTANT_LOAD, 0.0, &there, forces));
    expect(memcmp(first, forces, sizeof forces) == 0, "a restart goes on with the same bits");

    /* A handle that has been freed is refused. */
    check(ss_free(copy));
    expect(ss_state(copy, &state) == SS_NO_CONTACT && strlen(ss_last_error()) > 0, "a freed contact is refused");
    check(ss_free(ball));
    printf("ball: ok, stickslip %s\n", ss_version());
    return 0;
}
