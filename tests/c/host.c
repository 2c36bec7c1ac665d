/* A C host: loads the shared library, runs a whole simulation, compares two instances, and repeats
 * instantiate-run-free. Built with gcc -Wall -Wextra -Werror, run plain and under valgrind.
 *
 *   host LIBRARY GUID CYCLES VR_INPUT_X VR_LOAD VR_ALONG VR_UP VR_FORCE
 *
 * Prints the force after each step of the first cycle; exit code 0 means that all went well. On
 * Windows the same file, built with mingw, drives the DLL. */
#include "fmi2_host.h"

static int messages;

#define OK(call) if ((call) != 0) { fprintf(stderr, "failed: %s\n", #call); return 11; }

int main(int argc, char **argv) {
    if (argc < 9) return 2;
    int cycles = atoi(argv[3]);
    unsigned x = (unsigned)atoi(argv[4]), load = (unsigned)atoi(argv[5]);
    unsigned along = (unsigned)atoi(argv[6]), up = (unsigned)atoi(argv[7]);
    unsigned force = (unsigned)atoi(argv[8]);
    void *library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) { fprintf(stderr, "%s\n", dlerror()); return 9; }
    LOAD(fmi2Instantiate, Component (*)(const char *, int, const char *, const char *, const Callbacks *, int, int));
    LOAD(fmi2FreeInstance, void (*)(Component));
    LOAD(fmi2SetupExperiment, int (*)(Component, int, double, double, int, double));
    LOAD(fmi2EnterInitializationMode, int (*)(Component));
    LOAD(fmi2ExitInitializationMode, int (*)(Component));
    LOAD(fmi2Terminate, int (*)(Component));
    LOAD(fmi2SetReal, int (*)(Component, const unsigned *, size_t, const double *));
    LOAD(fmi2GetReal, int (*)(Component, const unsigned *, size_t, double *));
    LOAD(fmi2SetInteger, int (*)(Component, const unsigned *, size_t, const int *));
    LOAD(fmi2DoStep, int (*)(Component, double, double, int));
    LOAD(fmi2GetFMUstate, int (*)(Component, void **));
    LOAD(fmi2SetFMUstate, int (*)(Component, void *));
    LOAD(fmi2FreeFMUstate, int (*)(Component, void **));
    LOAD(fmi2Reset, int (*)(Component));

    Callbacks callbacks = {logger, calloc, free, NULL, &messages};
    double last = 0;
    for (int cycle = 0; cycle < cycles; cycle++) {
        Component block = fmi2Instantiate("block", 1, argv[2], NULL, &callbacks, 0, 0);
        if (!block) return 12;
        int elements[2] = {2, 2};
        unsigned mesh[2] = {along, up};
        double newtons = 56.25, h = 1e-5;
        void *state = NULL;
        OK(fmi2SetInteger(block, mesh, 2, elements));
        OK(fmi2SetReal(block, &load, 1, &newtons));
        OK(fmi2SetupExperiment(block, 0, 0, 0, 0, 0));
        OK(fmi2EnterInitializationMode(block));
        OK(fmi2ExitInitializationMode(block));
        for (int k = 0; k < 40; k++) {
            double position = -0.1 * k * h;
            OK(fmi2SetReal(block, &x, 1, &position));
            OK(fmi2DoStep(block, k * h, h, 0));
            if (cycle == 0) {
                double now = 0;
                OK(fmi2GetReal(block, &force, 1, &now));
                printf("%.17g\n", now);
            }
            if (k == 20) OK(fmi2GetFMUstate(block, &state));
        }
        double result = 0;
        OK(fmi2GetReal(block, &force, 1, &result));
        if (cycle > 0 && memcmp(&result, &last, sizeof last)) return 13;
        last = result;
        OK(fmi2SetFMUstate(block, state));
        OK(fmi2FreeFMUstate(block, &state));
        if (state) return 14;
        OK(fmi2Terminate(block));
        if (cycle % 2) OK(fmi2Reset(block));
        fmi2FreeInstance(block);
    }
    fmi2FreeInstance(NULL);
    /* What goes wrong is told, and only then. */
    if (messages) return 15;
    if (fmi2Instantiate("block", 1, "wrong GUID %s %n", NULL, &callbacks, 0, 0)) return 16;
    if (messages != 1) return 17;
    return 0;
}
