/* The exact tangential force of a contact with its slip history, as a sub-model for granular pair styles such as LAMMPS
 * GRANULAR: out of tree, and within a fixed number of doubles for each contact, which the pair style keeps and hands to
 * other processes.
 *
 * `StickslipTangential` is the arithmetic and needs no header but stickslip.h; with -DWITH_LAMMPS, and the headers of
 * LAMMPS, the class below makes a sub-model of it, which gran_sub_mod_register.cpp names. The history of a contact has
 * 3 + 2 K + 4 doubles: a unit vector along the tangential displacement, and the slip history along it. The vector turns
 * with the bodies, and with the displacement where that changes its direction. So motion to and fro along one line is
 * exact; for other motion the force is along the displacement, as in the sub-models of LAMMPS.
 */
#ifndef GRAN_SUB_MOD_TANGENTIAL_STICKSLIP_H
#define GRAN_SUB_MOD_TANGENTIAL_STICKSLIP_H

#include <cmath>
#include <stdexcept>
#include <string>

#include "stickslip.h"

class StickslipTangential {
public:
    /* Of a definition as ss_contact_new takes it, with so many turning points for each contact; `scale` is mu E* over G*,
     * the displacement of gross slip over the indentation. An object is used by one thread at a time. */
    StickslipTangential(const std::string &definition, double scale, int turning_points)
        : scale(scale), kept(turning_points), contact(nullptr) {
        check(ss_contact_new(definition.c_str(), &contact));
    }
    ~StickslipTangential() { ss_free(contact); }
    StickslipTangential(const StickslipTangential &) = delete;
    StickslipTangential &operator=(const StickslipTangential &) = delete;

    /* Doubles that the pair style keeps for each contact. All are zero before the bodies touch. */
    int size_history() const { return 3 + 2 * kept + 4; }

    /* Steps a contact: `n` is the unit normal, `overlap` the indentation, m, `vt` the relative tangential velocity, m/s,
     * and `fs` receives the tangential force on the first body, N. Returns the normal force, N, that belongs to it. */
    double step(double *history, const double *n, double overlap, const double *vt, double dt, double *fs) {
        double *axis = history, *slip = history + 3, u[3];
        /* The line of before, turned into the plane of contact, and the displacement from its origin. */
        project(axis, n);
        multiply(axis, length(axis) > 0.0 ? 1.0 / length(axis) : 0.0);
        for (int i = 0; i < 3; ++i)
            u[i] = axis[i] * slip[1] + vt[i] * dt;
        project(u, n);
        /* The line of now: the sign is the one that continues the line of before. */
        if (length(u) > 0.0) {
            double along = dot(axis, u), size = length(u);
            for (int i = 0; i < 3; ++i)
                axis[i] = (along < 0.0 ? -1.0 : 1.0) * u[i] / size;
        }
        double forces[2], to = dot(axis, u);
        check(ss_unpack_fixed(contact, kept, slip));
        check(ss_step(contact, SS_INDENTATION, overlap, &to, forces));
        check(ss_packed_fixed(contact, kept, slip, nullptr));
        /* Under gross slip the origin follows: the slip history does not depend on where it is. */
        double most = scale * std::fmax(overlap, 0.0);
        slip[1] = std::fmax(-most, std::fmin(most, slip[1]));
        for (int i = 0; i < 3; ++i)
            fs[i] = -forces[1] * axis[i];
        return forces[0];
    }

private:
    static double dot(const double *v, const double *w) { return v[0] * w[0] + v[1] * w[1] + v[2] * w[2]; }
    static double length(const double *v) { return std::sqrt(dot(v, v)); }
    static void multiply(double *v, double by) {
        for (int i = 0; i < 3; ++i)
            v[i] *= by;
    }
    static void project(double *v, const double *n) {
        double along = dot(v, n);
        for (int i = 0; i < 3; ++i)
            v[i] -= along * n[i];
    }
    static void check(int code) {
        if (code != SS_OK)
            throw std::runtime_error(ss_last_error());
    }

    double scale;
    int kept;
    ss_contact *contact;
};

#ifdef WITH_LAMMPS
#include <algorithm>
#include <map>
#include <memory>
#include <sstream>

#include "gran_sub_mod_normal.h"
#include "gran_sub_mod_tangential.h"
#include "granular_model.h"

namespace LAMMPS_NS {
namespace Granular_NS {

/* tangential stickslip FRICTION: the moduli are those of the normal model, hertz/material; one law for each radius. */
class GranSubModTangentialStickslip : public GranSubModTangential {
public:
    GranSubModTangentialStickslip(GranularModel *model, LAMMPS *lmp) : GranSubModTangential(model, lmp) {
        num_coeffs = 1;
        size_history = 3 + 2 * KEPT + 4;
    }
    void coeffs_to_local() override { mu = coeffs[0]; }
    void calculate_forces() override {
        std::unique_ptr<StickslipTangential> &law = laws[gm->Reff];
        if (!law)
            law.reset(new StickslipTangential(definition(), scale(), KEPT));
        double *kept = gm->history + history_index, copy[3 + 2 * KEPT + 4];
        std::copy(kept, kept + size_history, copy);
        law->step(copy, gm->nx, gm->delta, gm->vtr, gm->dt, gm->fs);
        if (gm->history_update)
            std::copy(copy, copy + size_history, kept);
    }

private:
    static const int KEPT = 8;

    /* mu E* over G* of two bodies of one material. */
    double scale() const {
        double nu = gm->normal_model->get_poiss();
        return mu * (2.0 - nu) / (2.0 * (1.0 - nu));
    }
    std::string definition() const {
        std::ostringstream text;
        text.precision(17);
        std::ostringstream body;
        body.precision(17);
        body << "{\"youngs_modulus\": " << gm->normal_model->get_emod() << ", \"poisson_ratio\": "
             << gm->normal_model->get_poiss() << "}";
        text << "{\"profile\": {\"type\": \"sphere\", \"radius\": " << gm->Reff << "}, \"material\": {\"bodies\": ["
             << body.str() << ", " << body.str() << "]}, \"friction\": " << mu << ", \"preload\": {\"indentation\": 0.0}}";
        return text.str();
    }

    std::map<double, std::unique_ptr<StickslipTangential>> laws;
};

}
}
#endif

#endif
