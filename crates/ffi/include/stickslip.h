/* The contacts of stickslip: frictional contact of two elastic bodies with its slip history, solved exactly.
 *
 * Every function returns SS_OK or another code of those below; ss_last_error has the text. Numbers are in SI units. Any
 * number of threads may call at once, each contact being used by one at a time. No call ends the program. Printed from
 * crates/ffi/src/exports.rs; docs/embedding.md says how to build and install the library. */
#ifndef STICKSLIP_H
#define STICKSLIP_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Done. */
#define SS_OK 0

/* A pointer that is needed is NULL, or not aligned. */
#define SS_NULL 1

/* The handle names no contact: it was freed, or never made. */
#define SS_NO_CONTACT 2

/* Another thread is using this contact. */
#define SS_BUSY 3

/* The definition is not valid JSON, or no definition of a contact. */
#define SS_INVALID_DEFINITION 4

/* A number is out of its range, or the contact cannot do this. The contact is as before. */
#define SS_REFUSED 5

/* There is no trial to commit. */
#define SS_NO_TRIAL 6

/* The buffer is too small. */
#define SS_BUFFER 7

/* The bytes or numbers are not a state of such a contact by this version of the library. */
#define SS_INVALID_STATE 8

/* Contacts of this kind do not have this. */
#define SS_NOT_AVAILABLE 9

/* A fault of the library; the contact is lost. Please report the text. */
#define SS_INTERNAL 10

/* The load of a step: as it is; the number is not read. */
#define SS_CONSTANT_LOAD 0

/* The load of a step: an indentation, m; below zero the bodies are apart. */
#define SS_INDENTATION 1

/* The load of a step: a normal force, N. */
#define SS_NORMAL_FORCE 2

/* Nothing slipped in the last step. */
#define SS_STICK 0

/* An outer ring slipped. */
#define SS_PARTIAL_SLIP 1

/* All of the contact slipped. */
#define SS_GROSS_SLIP 2

/* There is no contact. */
#define SS_SEPARATED 3

/* A contact. The pointer is a handle: it is never followed, and one that has been freed is refused. */
typedef struct ss_contact ss_contact;

/* The state of a contact. Along a line the second components are zero. */
typedef struct ss_contact_state {
    /* Tangential displacement of the indenter, m. */
    double displacement[2];
    /* Tangential force, N; a positive displacement gives a positive force. */
    double force[2];
    /* Indentation, m; below zero a gap. */
    double indentation;
    /* Normal force, N. */
    double normal_force;
    /* Contact radius, m. */
    double contact_radius;
    /* Radius of the part that did not slip in the last step, m. */
    double stick_radius;
    /* Friction work since the start, J. */
    double dissipated_energy;
    /* Elastic energy of the tangential deformation, J. */
    double elastic_energy;
    /* Turning points of the slip history; zero in the plane. */
    size_t turning_points;
    /* SS_STICK, SS_PARTIAL_SLIP, SS_GROSS_SLIP or SS_SEPARATED. */
    int regime;
} ss_contact_state;

/* Makes the contact of a definition: the JSON text that POST /contacts takes, in UTF-8, ending with a zero byte. The
 * contact is at rest under its preload and moves along a line. The handle written to `contact` belongs to the caller,
 * who frees it by ss_free; it is NULL if the call fails.
 * Pointers:
 * `json` is a text that ends with a zero byte, `contact` a place for one handle. */
int ss_contact_new(const char *json, ss_contact **contact);

/* Makes a contact that moves in the plane, solved by at most `rings` rings (4 to 160). As ss_contact_new.
 * Pointers:
 * As of ss_contact_new. */
int ss_planar_new(const char *json, size_t rings, ss_contact **contact);

/* Makes a copy of a contact with its state, which shares what follows from the definition: so arrays of contacts are
 * made. The handle belongs to the caller, who frees it by ss_free.
 * Pointers:
 * `copy` is a place for one handle. */
int ss_copy(const ss_contact *contact, ss_contact **copy);

/* Ends a contact. NULL is no contact, and nothing is done. */
int ss_free(ss_contact *contact);

/* Moves a contact straight to a load and a displacement, and commits it. `load` says what `normal` is:
 * SS_CONSTANT_LOAD, SS_INDENTATION (m) or SS_NORMAL_FORCE (N; the contact moves to the indentation of this force).
 * `displacement` has one number, m, in the plane two. `forces` receives the normal and then the tangential force, N:
 * two numbers, in the plane three. A step that fails has moved nothing. A trial is discarded.
 * Pointers:
 * `displacement` and `forces` have so many numbers. */
int ss_step(ss_contact *contact, int load, double normal, const double *displacement, double *forces);

/* The forces that such a step would lead to, from the committed state on: for iterations of one time step. The trial
 * is kept until ss_commit, ss_revert, the next trial or the next step. As ss_step.
 * Pointers:
 * As of ss_step. */
int ss_trial(ss_contact *contact, int load, double normal, const double *displacement, double *forces);

/* Makes the state of the last trial the committed one. */
int ss_commit(ss_contact *contact);

/* Discards the last trial, if there is one. */
int ss_revert(ss_contact *contact);

/* Steps `count` contacts of one kind, one after the other, each as ss_step does: contact i to `normal[i]` and to
 * its numbers of `displacement`; its forces follow those of contact i - 1. `normal` may be NULL under
 * SS_CONSTANT_LOAD.
 * Ends at the first contact that fails; `done` receives how many were stepped, and may be NULL. Threads may call it at
 * once for different contacts.
 * Pointers:
 * `contacts` has `count` handles, `normal` as many numbers, `displacement` and `forces` as many times the numbers of
 * one contact. */
int ss_step_many(ss_contact *const *contacts, size_t count, int load, const double *normal, const double *displacement, double *forces, size_t *done);

/* The committed state.
 * Pointers:
 * `state` is a place for one state. */
int ss_state(const ss_contact *contact, ss_contact_state *state);

/* Normal stiffness and tangential stiffness, N/m, of the last trial or else of the committed state: two numbers. The
 * tangential one is that of a displacement that goes on upwards, or downwards if `direction` is negative. Not in the
 * plane.
 * Pointers:
 * `stiffness` is a place for two numbers. */
int ss_stiffness(const ss_contact *contact, int direction, double *stiffness);

/* Writes the committed state with its history as bytes, for a restart by the same version of the library on a machine
 * of the same kind. `length` receives how many there are: with a `capacity` of zero, `bytes` may be NULL and the call
 * only asks that.
 * Pointers:
 * `bytes` is a place for `capacity` bytes, `length` one for a number. */
int ss_pack(const ss_contact *contact, void *bytes, size_t capacity, size_t *length);

/* Makes the state that ss_pack has written the committed one. The contact has the definition of the one that was
 * packed; that is checked by its preload.
 * Pointers:
 * `bytes` has `length` bytes. */
int ss_unpack(ss_contact *contact, const void *bytes, size_t length);

/* Writes the committed state in 2 `turning_points` + 4 doubles, for programs that keep so many for each contact.
 * `dropped`, which may be NULL, receives 1 if turning points were dropped, the smallest loops first: the force then
 * has an error, stays below friction times the normal force, and no cycle yields work. Otherwise it receives 0, and
 * the state is the same but for rounding. What slipped in the last step is not kept. Not in the plane.
 * Pointers:
 * `numbers` is a place for so many doubles, `dropped` NULL or a place for one int. */
int ss_packed_fixed(const ss_contact *contact, size_t turning_points, double *numbers, int *dropped);

/* Makes the state that ss_packed_fixed has written the committed one.
 * Pointers:
 * `numbers` has 2 `turning_points` + 4 doubles. */
int ss_unpack_fixed(ss_contact *contact, size_t turning_points, const double *numbers);

/* What was wrong with the last call of this thread that failed: a text that belongs to the library and is valid until
 * the next failure of this thread. */
const char *ss_last_error(void);

/* The version of the library, such as "0.1.0": a text that is valid for ever. Within 0.x functions are added and none
 * is changed. */
const char *ss_version(void);

#ifdef __cplusplus
}
#endif

#endif
