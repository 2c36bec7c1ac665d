/* The FMU driven from C: one sliding run as fmpy drives it, without Python.
 *
 *   fmu_host LIBRARY GUID STEP STEPS REPEATS VR_X VR_LOAD VR_OUT
 *
 * h 10, l 15 mm (the FMU's own start values), 56.25 N, 0.3 m/s after a ramp of 0.5 ms; one input set, one
 * output read per step. Prints the seconds of each run. */
#include "../../tests/c/fmi2_host.h"
#include <time.h>

#define OK(call) if ((call) != 0) { fprintf(stderr, "failed: %s\n", #call); return 3; }

int main(int argc, char **argv) {
    if (argc != 9) return 2;
    double h = atof(argv[3]);
    int steps = atoi(argv[4]), repeats = atoi(argv[5]);
    unsigned x = (unsigned)atoi(argv[6]), load = (unsigned)atoi(argv[7]), out = (unsigned)atoi(argv[8]);
    void *library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) { fprintf(stderr, "%s\n", dlerror()); return 4; }
    LOAD(fmi2Instantiate, Component (*)(const char *, int, const char *, const char *, const Callbacks *, int, int));
    LOAD(fmi2FreeInstance, void (*)(Component));
    LOAD(fmi2SetupExperiment, int (*)(Component, int, double, double, int, double));
    LOAD(fmi2EnterInitializationMode, int (*)(Component));
    LOAD(fmi2ExitInitializationMode, int (*)(Component));
    LOAD(fmi2Reset, int (*)(Component));
    LOAD(fmi2SetReal, int (*)(Component, const unsigned *, size_t, const double *));
    LOAD(fmi2GetReal, int (*)(Component, const unsigned *, size_t, double *));
    LOAD(fmi2DoStep, int (*)(Component, double, double, int));
    Callbacks callbacks = {logger, calloc, free, NULL, NULL};
    Component block = fmi2Instantiate("block", 1, argv[2], "", &callbacks, 0, 0);
    if (!block) return 5;
    double force = 56.25, belt, seen, sum = 0;
    for (int r = 0; r < repeats; r++) {
        OK(fmi2SetReal(block, &load, 1, &force));
        OK(fmi2SetupExperiment(block, 0, 0, 0, 0, 0));
        OK(fmi2EnterInitializationMode(block));
        OK(fmi2ExitInitializationMode(block));
        struct timespec a, b;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &a);
        for (int k = 0; k < steps; k++) {
            double t = k * h, ramp = 0.5e-3;
            belt = t < ramp ? -0.3 * t * t / (2 * ramp) : -0.3 * (t - ramp / 2);
            OK(fmi2SetReal(block, &x, 1, &belt));
            OK(fmi2DoStep(block, t, (k + 1) * h - t, 1));
            OK(fmi2GetReal(block, &out, 1, &seen));
            sum += seen;
        }
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &b);
        printf("%g\n", (double)(b.tv_sec - a.tv_sec) + 1e-9 * (double)(b.tv_nsec - a.tv_nsec));
        OK(fmi2Reset(block));
    }
    fmi2FreeInstance(block);
    return sum == sum ? 0 : 6;
}
