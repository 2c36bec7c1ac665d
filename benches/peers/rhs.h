/* The reduced equations of benches/block/equations.rs as a compiled right-hand side.
 *
 * State: modal amplitudes z, their rates w, height of the clamped face and its rate: 2 modes + 2 numbers. */
#ifndef TREAD_RHS_H
#define TREAD_RHS_H

typedef struct Problem Problem;

/* Reads what `block export` wrote; ends the program if it cannot. */
Problem *problem_read(const char *path);
/* Number of states. */
int problem_size(const Problem *p);
/* State at t = 0. */
void problem_start(const Problem *p, double *y);
/* dy/dt. */
void problem_rhs(Problem *p, double t, const double *y, double *dy);
/* Its Jacobian times v. */
void problem_jvp(Problem *p, double t, const double *y, const double *v, double *jv);
/* Run-in edge's displacement [m] and velocity [m/s], friction coefficient of the contact [-]. */
void problem_observe(Problem *p, double t, const double *y, double out[3]);
/* Right-hand sides evaluated so far. */
long problem_calls(const Problem *p);

#endif
