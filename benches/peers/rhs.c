#include "rhs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct Problem {
    int modes, nodes;
    long calls;
    double *omega2, *area, *phi_x, *phi_z, *gamma, *body, *contact, *friction, *road, *z, *height;
    double *force, *ux, *uz, *vx, *vz, *acceleration, schur;
};

static double *section(FILE *file, const char *name, int *count) {
    char found[32];
    if (fscanf(file, "%31s %d", found, count) != 2 || strcmp(found, name)) {
        fprintf(stderr, "section %s is missing\n", name);
        exit(2);
    }
    double *values = aligned_alloc(64, ((size_t)*count * sizeof(double) + 63) / 64 * 64);
    for (int i = 0; i < *count; i++)
        if (fscanf(file, "%lf", &values[i]) != 1) exit(2);
    return values;
}

Problem *problem_read(const char *path) {
    FILE *file = fopen(path, "r");
    if (!file) { perror(path); exit(2); }
    Problem *p = calloc(1, sizeof *p);
    int count;
    p->omega2 = section(file, "omega2", &p->modes);
    p->area = section(file, "area", &p->nodes);
    p->phi_x = section(file, "phi_x", &count);
    p->phi_z = section(file, "phi_z", &count);
    p->gamma = section(file, "gamma", &count);
    p->body = section(file, "body", &count);
    p->contact = section(file, "contact", &count);
    p->friction = section(file, "friction", &count);
    p->road = section(file, "road", &count);
    p->z = section(file, "z", &count);
    p->height = section(file, "height", &count);
    fclose(file);
    p->force = calloc((size_t)(6 * p->nodes + p->modes), sizeof(double));
    p->ux = p->force + 2 * p->nodes;
    p->uz = p->ux + p->nodes;
    p->vx = p->uz + p->nodes;
    p->vz = p->vx + p->nodes;
    p->acceleration = p->vz + p->nodes;
    p->schur = p->body[1];
    for (int m = 0; m < p->modes; m++) p->schur -= p->gamma[m] * p->gamma[m];
    return p;
}

int problem_size(const Problem *p) { return 2 * p->modes + 2; }

long problem_calls(const Problem *p) { return p->calls; }

void problem_start(const Problem *p, double *y) {
    memset(y, 0, (size_t)problem_size(p) * sizeof *y);
    memcpy(y, p->z, (size_t)p->modes * sizeof *y);
    y[2 * p->modes] = p->height[0];
}

/* y = A x for A of rows x columns, row by row. */
static void product(int rows, int columns, const double *restrict a, const double *restrict x,
                    double *restrict y) {
    for (int i = 0; i < rows; i++) {
        double sum = 0;
        for (int j = 0; j < columns; j++) sum += a[i * columns + j] * x[j];
        y[i] = sum;
    }
}

/* Forces of the road on the contact nodes; returns friction and normal force. */
static void forces(Problem *p, double t, const double *y, double total[2]) {
    int n = p->nodes, modes = p->modes;
    const double *z = y, *w = y + modes, *law = p->friction;
    double height = y[2 * modes], ramp = p->road[1];
    double road = p->road[0] * (t < ramp ? t / ramp : 1.0);
    double *fx = p->force, *fz = p->force + n;
    product(n, modes, p->phi_z, z, p->uz);
    product(n, modes, p->phi_x, w, p->vx);
    total[0] = total[1] = 0;
    for (int i = 0; i < n; i++) {
        double compression = -(height - p->body[4] + p->uz[i]);
        double pressure =
            compression > 0 ? p->contact[0] * expm1(compression / p->contact[1]) : 0.0;
        double v = p->vx[i] - road, bounded = pressure > 1e3 ? pressure : 1e3;
        double fall = exp(-pow(fabs(v) / law[2], law[3]));
        double mu = M_2_PI * atan(v / law[4]) * pow(bounded / law[6], law[5]) *
                    (law[0] + law[1] * fall);
        fz[i] = pressure * p->area[i];
        fx[i] = -mu * fz[i];
        total[0] += fx[i];
        total[1] += fz[i];
    }
}

/* Rates from the contact forces in p->force; `load` is what the carriage bears. */
static void rates(Problem *p, const double *y, double normal, double load, double *dy) {
    int n = p->nodes, modes = p->modes;
    const double *z = y, *w = y + modes;
    double lift = y[2 * modes + 1], *acceleration = dy + modes;
    for (int m = 0; m < modes; m++)
        acceleration[m] = -p->omega2[m] * (z[m] + p->body[0] * w[m]);
    for (int i = 0; i < n; i++) {
        const double *px = p->phi_x + i * modes, *pz = p->phi_z + i * modes;
        double fx = p->force[i], fz = p->force[n + i];
        for (int m = 0; m < modes; m++) acceleration[m] += px[m] * fx + pz[m] * fz;
    }
    double inner = 0;
    for (int m = 0; m < modes; m++) inner += p->gamma[m] * acceleration[m];
    double up = (normal - load - p->body[2] * lift - inner) / p->schur;
    for (int m = 0; m < modes; m++) acceleration[m] -= p->gamma[m] * up;
    memcpy(dy, w, (size_t)modes * sizeof *dy);
    dy[2 * modes] = lift;
    dy[2 * modes + 1] = up;
}

void problem_rhs(Problem *p, double t, const double *y, double *dy) {
    double total[2];
    p->calls++;
    forces(p, t, y, total);
    rates(p, y, total[1], p->body[3], dy);
}

void problem_jvp(Problem *p, double t, const double *y, const double *v, double *jv) {
    int n = p->nodes, modes = p->modes;
    const double *law = p->friction;
    double total[2], normal = 0, ramp = p->road[1];
    double road = p->road[0] * (t < ramp ? t / ramp : 1.0);
    forces(p, t, y, total);
    for (int i = 0; i < n; i++) {
        double dz = 0, dv = 0, c = -(y[2 * modes] - p->body[4] + p->uz[i]);
        for (int m = 0; m < modes; m++) {
            dz += p->phi_z[i * modes + m] * v[m];
            dv += p->phi_x[i * modes + m] * v[modes + m];
        }
        double slip = p->vx[i] - road, at = fabs(slip) / law[2];
        double pressure = c > 0 ? p->contact[0] * expm1(c / p->contact[1]) : 0.0;
        double dp = c > 0 ? -(v[2 * modes] + dz) * p->contact[0] / p->contact[1] * exp(c / p->contact[1]) : 0.0;
        double level = pow((pressure > 1e3 ? pressure : 1e3) / law[6], law[5]);
        double fall = exp(-pow(at, law[3])), smooth = slip / law[4];
        double sign = M_2_PI * atan(smooth), mu = sign * level * (law[0] + law[1] * fall);
        double slope = level * (M_2_PI / law[4] / (1 + smooth * smooth) * (law[0] + law[1] * fall) -
                                fabs(sign) * law[1] * fall * law[3] * pow(at, law[3] - 1) / law[2]);
        double by_p = pressure > 1e3 ? law[5] * mu / pressure : 0.0;
        p->force[i] = -p->area[i] * (mu * dp + pressure * (slope * dv + by_p * dp));
        p->force[n + i] = p->area[i] * dp;
        normal += p->force[n + i];
    }
    rates(p, v, normal, 0, jv);
}

void problem_observe(Problem *p, double t, const double *y, double out[3]) {
    double total[2];
    forces(p, t, y, total);
    out[0] = out[1] = 0;
    for (int m = 0; m < p->modes; m++) {
        out[0] += p->phi_x[m] * y[m];
        out[1] += p->phi_x[m] * y[p->modes + m];
    }
    out[2] = total[1] > 0 ? total[0] / total[1] : 0;
}
