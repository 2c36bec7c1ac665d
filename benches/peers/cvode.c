/* CVODE (BDF, Newton, dense Jacobian, exact or by differences, whichever is named) on the reduced equations.
 *
 *   cvode exact|differences MODEL RTOL ATOL DURATION STEP TRACE
 *
 * ATOL is for displacements in the scale of the modes; velocities get 2e4 times that, their scale at some
 * kilohertz. Writes a trace for `tread metrics`, prints processor time and work as JSON. */
#include "rhs.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <time.h>

static int rhs(realtype t, N_Vector y, N_Vector dy, void *data) {
    problem_rhs(data, t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
    return 0;
}

static int jacobian(realtype t, N_Vector y, N_Vector dy, SUNMatrix j, void *data, N_Vector a, N_Vector b,
                    N_Vector c) {
    (void)dy, (void)b, (void)c;
    double *unit = N_VGetArrayPointer(a);
    int size = problem_size(data);
    N_VConst(0, a);
    for (int i = 0; i < size; i++) {
        unit[i] = 1;
        problem_jvp(data, t, N_VGetArrayPointer(y), unit, SUNDenseMatrix_Column(j, i));
        unit[i] = 0;
    }
    return 0;
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(int argc, char **argv) {
    if (argc != 8) return 2;
    double rtol = atof(argv[3]), atol = atof(argv[4]), end = atof(argv[5]), step = atof(argv[6]);
    Problem *p = problem_read(argv[2]);
    int size = problem_size(p), modes = size / 2 - 1;
    SUNContext context;
    SUNContext_Create(NULL, &context);
    N_Vector y = N_VNew_Serial(size, context), tolerance = N_VNew_Serial(size, context);
    problem_start(p, N_VGetArrayPointer(y));
    for (int i = 0; i < size; i++)
        N_VGetArrayPointer(tolerance)[i] =
            atol * ((i >= modes && i < 2 * modes) || i == size - 1 ? 2e4 : 1.0);
    void *solver = CVodeCreate(CV_BDF, context);
    CVodeInit(solver, rhs, 0.0, y);
    CVodeSVtolerances(solver, rtol, tolerance);
    CVodeSetUserData(solver, p);
    CVodeSetMaxNumSteps(solver, 100000000);
    SUNMatrix matrix = SUNDenseMatrix(size, size, context);
    CVodeSetLinearSolver(solver, SUNLinSol_Dense(y, matrix, context), matrix);
    if (argv[1][0] == 'e') CVodeSetJacFn(solver, jacobian);
    FILE *trace = fopen(argv[7], "w");
    fprintf(trace, "time,run_in.displacement.x,run_in.velocity.x,contact.friction_coefficient,"
                   "contact.stick_fraction\n");
    int rows = (int)(end / step + 0.5);
    double spent = 0, out[3], t = 0;
    for (int k = 0; k <= rows; k++) {
        double start = now();
        if (k > 0 && CVode(solver, k * step, y, &t, CV_NORMAL) < 0) return 3;
        spent += now() - start;
        problem_observe(p, t, N_VGetArrayPointer(y), out);
        fprintf(trace, "%.17g,%.17g,%.17g,%.17g,0\n", k * step, out[0], out[1], out[2]);
    }
    fclose(trace);
    long steps;
    CVodeGetNumSteps(solver, &steps);
    printf("{\"seconds\": [%g], \"duration\": %g, \"steps\": %ld, \"calls\": %ld}\n", spent, end, steps,
           problem_calls(p));
    return 0;
}
