// The branchy loop of benches/intersection.rs for other emulators: the same rays and triangles, the same numbers (Q16.16, each result
// rounded to the nearest, ties up), the same early outs, the same checksum. Nothing here saturates: on these triangles nothing has to,
// and the checksum would show it. Timing is left to run.sh, which compares few passes with many.

#include <stdint.h>

enum { RAYS = 64, TRIANGLES = 4096 };

typedef struct { int32_t x, y, z; } vector;
typedef struct { vector corner, edge1, edge2; } triangle;
typedef struct { vector origin, direction; } ray;

static triangle triangles[TRIANGLES];
static ray rays[RAYS];
static uint64_t state = 1;

// A number in Q16.16 from the generator of benches/intersection.rs.
static int32_t unit(double from, double to) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (int32_t)((from + (double)(state >> 40) / (1 << 24) * (to - from)) * 65536.0);
}

static vector point(double x, double y, double z) {
    vector made;
    made.x = unit(-x, x);
    made.y = unit(-y, y);
    made.z = unit(-z, z);
    return made;
}

static void make(void) {
    state = 1;
    for (int at = 0; at < TRIANGLES; at++) {
        triangles[at].corner = point(8.0, 8.0, 4.0);
        triangles[at].edge1 = point(3.0, 3.0, 1.0);
        triangles[at].edge2 = point(3.0, 3.0, 1.0);
    }
    for (int at = 0; at < RAYS; at++) {
        int32_t x = at % 8 * 2000, y = at / 8 * 2000;
        rays[at].origin = (vector){ x, y, 12 << 16 };
        rays[at].direction = (vector){ x / 16, y / 16, -65536 };
    }
}

static inline int32_t rounded(int64_t value) {
    return (int32_t)((value + 32768) >> 16);
}

static inline int64_t product(int32_t a, int32_t b) {
    return (int64_t)a * b;
}

static inline vector cross(vector a, vector b) {
    return (vector){ rounded(product(a.y, b.z) - product(a.z, b.y)), rounded(product(a.z, b.x) - product(a.x, b.z)),
                     rounded(product(a.x, b.y) - product(a.y, b.x)) };
}

static inline int32_t dot(vector a, vector b) {
    return rounded(product(a.x, b.x) + product(a.y, b.y) + product(a.z, b.z));
}

static inline int32_t distance(const ray *ray, const triangle *triangle) {
    vector p = cross(ray->direction, triangle->edge2);
    int32_t determinant = dot(triangle->edge1, p);
    if (determinant <= 0) return 0;
    vector start = { ray->origin.x - triangle->corner.x, ray->origin.y - triangle->corner.y, ray->origin.z - triangle->corner.z };
    int32_t u = dot(start, p);
    if (u < 0 || u > determinant) return 0;
    vector q = cross(start, triangle->edge1);
    int32_t v = dot(ray->direction, q);
    if (v < 0 || (int32_t)((uint32_t)u + (uint32_t)v) > determinant) return 0;
    int32_t t = dot(triangle->edge2, q);
    if (t <= 0) return 0;
    return (int32_t)((((int64_t)t << 16) + determinant / 2) / determinant);
}

// Tests all rays against all triangles, `passes` times; the checksum of the last pass.
#ifdef __wasm__
__attribute__((export_name("run")))
#endif
int32_t run(int32_t passes) {
    uint32_t sum = 0;
    make();
    while (passes-- > 0) {
        sum = 0;
        // What was computed before is no longer known.
        __asm__ volatile("" ::: "memory");
        for (int at = 0; at < RAYS; at++)
            for (int number = 0; number < TRIANGLES; number++) sum += (uint32_t)distance(&rays[at], &triangles[number]);
    }
    return (int32_t)sum;
}

#ifndef __wasm__
#include <stdio.h>
#include <stdlib.h>

int main(int count, char **arguments) {
    printf("%d\n", run(count > 1 ? atoi(arguments[1]) : 1));
    return 0;
}
#endif
