// A crowd of driven discs in Box2D: reads what to do from standard input, and prints how long each piece took.
//
// Input, as native float32: the fields of Setup, then x and y of all discs, then for each piece the three arrays of its
// forces. Output: seconds per piece, one line each, then the mean speed of the discs at the end.

#include <box2d/box2d.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

typedef struct {
  float discs, side, radius, density, friction, restitution, linear_damping, angular_damping;
  float dt, substeps;  // of one call of b2World_Step
  float calls;         // per step; the force acts in the first
  float pieces, steps;
} Setup;

static void read_floats(float* values, size_t count) {
  if (fread(values, sizeof(float), count, stdin) != count) {
    fprintf(stderr, "the input ends early\n");
    exit(2);
  }
}

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

int main(void) {
  Setup setup;
  read_floats((float*)&setup, sizeof(Setup) / sizeof(float));
  const int discs = (int)setup.discs;
  float* arrays = malloc(3 * sizeof(float) * (size_t)discs);
  b2BodyId* bodies = malloc(sizeof(b2BodyId) * (size_t)discs);

  b2SetLengthUnitsPerMeter(setup.radius);
  b2WorldDef world_def = b2DefaultWorldDef();
  world_def.gravity = (b2Vec2){0.0f, 0.0f};
  world_def.enableSleep = false;
  world_def.enableContinuous = false;
  const b2WorldId world = b2CreateWorld(&world_def);
  b2ShapeDef shape_def = b2DefaultShapeDef();
  shape_def.density = setup.density;
  shape_def.material.friction = setup.friction;
  shape_def.material.restitution = setup.restitution;

  b2BodyDef body_def = b2DefaultBodyDef();
  const b2BodyId ground = b2CreateBody(world, &body_def);
  const b2Vec2 corners[4] = {{0.0f, 0.0f}, {0.0f, setup.side}, {setup.side, setup.side}, {setup.side, 0.0f}};
  for (int i = 0; i < 4; ++i) {
    const b2Segment wall = {corners[i], corners[(i + 1) % 4]};
    b2CreateSegmentShape(ground, &shape_def, &wall);
  }
  body_def.type = b2_dynamicBody;
  body_def.linearDamping = setup.linear_damping;
  body_def.angularDamping = setup.angular_damping;
  const b2Circle circle = {{0.0f, 0.0f}, setup.radius};
  read_floats(arrays, 2 * (size_t)discs);
  for (int i = 0; i < discs; ++i) {
    body_def.position = (b2Vec2){arrays[i], arrays[discs + i]};
    bodies[i] = b2CreateBody(world, &body_def);
    b2CreateCircleShape(bodies[i], &shape_def, &circle);
  }

  for (int piece = 0; piece < (int)setup.pieces; ++piece) {
    read_floats(arrays, 3 * (size_t)discs);
    const double begun = now();
    for (int step = 0; step < (int)setup.steps; ++step) {
      for (int i = 0; i < discs; ++i) {
        b2Body_ApplyForceToCenter(bodies[i], (b2Vec2){arrays[i], arrays[discs + i]}, true);
        b2Body_ApplyTorque(bodies[i], arrays[2 * discs + i], true);
      }
      for (int call = 0; call < (int)setup.calls; ++call) {
        b2World_Step(world, setup.dt, (int)setup.substeps);
      }
    }
    printf("%.9f\n", now() - begun);
  }

  double speed = 0.0;
  for (int i = 0; i < discs; ++i) {
    const b2Vec2 velocity = b2Body_GetLinearVelocity(bodies[i]);
    speed += hypot(velocity.x, velocity.y);
  }
  printf("%.9f\n", speed / discs);
  return 0;
}
