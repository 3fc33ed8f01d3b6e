// The arithmetic of the sub-model, without LAMMPS: along a line it is the contact itself, in a plane that turns as well.
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "gran_sub_mod_tangential_stickslip.h"

static const char *BALL =
    "{\"profile\": {\"type\": \"sphere\", \"radius\": 0.01},"
    " \"material\": {\"effective\": {\"e_star\": 1.15e11, \"g_star\": 8.5e10}},"
    " \"friction\": 0.3, \"preload\": {\"indentation\": 0.0}}";

static void expect(bool holds, const char *what) {
    if (!holds) {
        std::fprintf(stderr, "not so: %s\n", what);
        std::exit(1);
    }
}

int main() {
    const double scale = 0.3 * 1.15e11 / 8.5e10;
    StickslipTangential law(BALL, scale, 8);
    ss_contact *exact = nullptr;
    expect(ss_contact_new(BALL, &exact) == SS_OK, "a contact is made");
    std::vector<double> history(law.size_history(), 0.0);
    const double dt = 1e-6, pi = 3.14159265358979323846;
    double there = 0.0, worst = 0.0;
    for (int step = 1; step <= 4000; ++step) {
        // The bodies roll about y: the normal turns, and with it the line of motion.
        const double turn = 2e-4 * step;
        const double n[3] = {std::sin(turn), 0.0, std::cos(turn)}, along[3] = {std::cos(turn), 0.0, -std::sin(turn)};
        const double overlap = 1e-7 * (1.0 + 0.2 * std::sin(2.0 * pi * step / 700.0));
        const double to = 1.2 * scale * 1e-7 * std::sin(2.0 * pi * step / 1000.0) * (1.0 - step / 8000.0), speed = (to - there) / dt;
        const double vt[3] = {along[0] * speed, along[1] * speed, along[2] * speed};
        double fs[3], forces[2];
        const double normal = law.step(history.data(), n, overlap, vt, dt, fs);
        there = to;
        expect(ss_step(exact, SS_INDENTATION, overlap, &there, forces) == SS_OK, "a step is made");
        // The line is kept to the rotation of one step.
        const double found = -(fs[0] * along[0] + fs[1] * along[1] + fs[2] * along[2]);
        worst = std::fmax(worst, std::fabs(found - forces[1]) / (0.3 * normal));
        expect(normal == forces[0], "the normal force is the same");
        expect(std::sqrt(fs[0] * fs[0] + fs[1] * fs[1] + fs[2] * fs[2]) <= 0.3 * normal * (1.0 + 1e-12),
               "friction bounds the force");
    }
    expect(worst < 1e-3, "the force is that of the contact");
    // Bodies that part lose their history.
    const double n[3] = {0.0, 0.0, 1.0}, none[3] = {0.0, 0.0, 0.0};
    double fs[3];
    expect(law.step(history.data(), n, -1e-8, none, dt, fs) == 0.0 && fs[0] == 0.0, "apart there is no force");
    ss_free(exact);
    std::printf("lammps: ok, the largest difference is %.1e of friction times load\n", worst);
    return 0;
}
