/* Peak of one core in double precision: independent fused multiply-adds on vectors of 8 and of 4 doubles,
 * enough of them to hide the latency; prints the best of five in flops per second. */
#include <stdio.h>
#include <time.h>

#define LOOP(name, bytes, width, count)                                                            \
    typedef double name##_v __attribute__((vector_size(bytes)));                                   \
    static double name(double *sink) {                                                             \
        name##_v x[count], m = {0}, c = {0};                                                       \
        m += 0.999999;                                                                             \
        c += 1e-6;                                                                                 \
        for (int i = 0; i < count; i++) x[i] = m * (i + 1);                                        \
        struct timespec a, b;                                                                      \
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &a);                                                        \
        const long rounds = 20000000;                                                              \
        for (long k = 0; k < rounds; k++)                                                          \
            for (int i = 0; i < count; i++) x[i] = x[i] * m + c;                                   \
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &b);                                                        \
        for (int i = 0; i < count; i++) *sink += x[i][0];                                          \
        double seconds = (double)(b.tv_sec - a.tv_sec) + 1e-9 * (double)(b.tv_nsec - a.tv_nsec);   \
        return 2.0 * width * count * rounds / seconds;                                             \
    }

LOOP(wide, 64, 8, 12)
LOOP(narrow, 32, 4, 12)

int main(void) {
    double best = 0, sink = 0;
    for (int k = 0; k < 5; k++) {
        double w = wide(&sink), n = narrow(&sink);
        best = w > best ? w : best;
        best = n > best ? n : best;
    }
    fprintf(stderr, "%g\n", sink);
    printf("%g\n", best);
    return 0;
}
