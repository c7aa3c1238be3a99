/* A ray intersector of your own, for `alhazen crosscheck --intersector FILE.so`.
 *
 * Build a shared library that exports one C function,
 *
 *     const struct alhazen_intersector* alhazen_get_intersector(void);
 *
 * whose result stays valid. This header needs nothing but itself, in C or C++. docs/crosscheck.md walks through an
 * example, examples/naive_sphere.cpp.
 */
#ifndef ALHAZEN_INTERSECTOR_PLUGIN_H
#define ALHAZEN_INTERSECTOR_PLUGIN_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ALHAZEN_INTERSECTOR_VERSION 1u
#define ALHAZEN_NO_FACE 0xFFFFFFFFu

/* The points origin + t direction with t_min <= t <= t_max. The direction has any length but 0; t counts in it. */
struct alhazen_ray {
  float origin[3], direction[3];
  float t_min, t_max;
};

struct alhazen_hit {
  float t;
  uint32_t face;   /* box: 2 axis + side (1: the upper); cylinder: 2 and 3 the caps, 6 the wall. ALHAZEN_NO_FACE where
                      you do not say: faces are then not compared. */
  float normal[3]; /* outward, of any length; zero where you do not say: normals are then not compared */
};

struct alhazen_intersector {
  uint32_t version;    /* ALHAZEN_INTERSECTOR_VERSION */
  const char* name;    /* for the report */
  const char* surface; /* what it claims to be, one of
                              "sphere RADIUS"                              about the origin
                              "cylinder HEIGHT BOTTOM_RADIUS TOP_RADIUS"   about the y axis, with caps; a cone, too
                              "tube HEIGHT BOTTOM_RADIUS TOP_RADIUS"       the same without caps
                              "disk RADIUS INNER_RADIUS"                   in the plane y = 0
                              "box X Y Z"                                  sizes, about the origin
                              "triangle AX AY AZ BX BY BZ CX CY CZ"  */

  /* A box that holds the surface: rays that miss it are not asked. */
  void (*bounds)(float lower[3], float upper[3]);

  /* The closest hit. Returns 1 and fills `hit`, or returns 0. Must be safe from several threads at once. */
  int (*intersect)(const struct alhazen_ray* ray, struct alhazen_hit* hit);

  /* Optional (null): the same for several rays at once, hit_something[i] being what `intersect` returns. */
  void (*intersect_packet)(const struct alhazen_ray* rays, int count, struct alhazen_hit* hits, int* hit_something);
};

const struct alhazen_intersector* alhazen_get_intersector(void);

#ifdef __cplusplus
}
#endif
#endif
