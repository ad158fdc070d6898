/* The reference workload, one mission after the other: the same work as cardume's kernel does for mission.yaml. */
#define _GNU_SOURCE
#include "workload.h"
#include <math.h>
#include <string.h>

typedef struct { double north, east, heading, surge, sway, yaw_rate; } state;
typedef struct { int segment; double arc; } place;
typedef struct { double course, curvature, cross_track, gamma, stretch; int finished; } on_path;
typedef struct { double state, speed, valid; int known, fresh; double predicted, correction; int has_view; } news;
typedef struct { double north, east, time; place place; } sighting;
typedef struct { double valid, state, speed; sighting seen[VEHICLES]; news told[VEHICLES]; } message;

typedef struct {
  state now, before;                                /* true */
  place true_place;
  on_path truth;
  double thrust, moment, power;
  place place;                                      /* believed */
  double position[2], reckoned[2], time_of_fix, current[2], observed[2], observed_current[2];
  int observes, finished;
  double surge, sway, cross_track, gamma, path_speed, integral, last_sent;
  double course, heading, speed, correction;        /* wanted */
  news others[VEHICLES];
  sighting seen[VEHICLES];
  message outbox;
  double arrives[VEHICLES];                         /* from each */
  int hears[VEHICLES], sends;
  double below, first_state, last_yaw_rate, away[2];
  double sums[VEHICLE_SUMS];
} vehicle;

static inline double square(double x) { return x * x; }
static inline double wrap(double a) { return a - TWO_PI * rint(a * (1.0 / TWO_PI)); }
static inline double clip(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

static inline void philox(uint64_t seed, uint32_t c[4]) {
  uint32_t k0 = (uint32_t)seed, k1 = (uint32_t)(seed >> 32);
  for (int round = 0; round < ROUNDS; round++) {
    uint64_t p0 = (uint64_t)M_0 * c[0], p1 = (uint64_t)M_1 * c[2];
    c[0] = (uint32_t)(p1 >> 32) ^ c[1] ^ k0;
    c[1] = (uint32_t)p1;
    c[2] = (uint32_t)(p0 >> 32) ^ c[3] ^ k1;
    c[3] = (uint32_t)p0;
    k0 += WEYL_0;
    k1 += WEYL_1;
  }
}
static inline double unit(uint32_t word) { return ((double)word + 0.5) * 0x1p-32; }
static inline double uniform(uint64_t seed, uint32_t tick, uint32_t stream, uint32_t a, uint32_t b) {
  uint32_t c[4] = {tick, stream, a, b};
  philox(seed, c);
  return unit(c[0]);
}
/* two or, with `all`, three of the four normal numbers */
static inline void normals(uint64_t seed, uint32_t tick, uint32_t stream, uint32_t a, uint32_t b, int all, double n[3]) {
  uint32_t c[4] = {tick, stream, a, b};
  philox(seed, c);
  double size = sqrt(-2.0 * log(unit(c[0]))), s, k;
  sincos(TWO_PI * unit(c[1]), &s, &k);
  n[0] = size * k;
  n[1] = size * s;
  if (all) n[2] = sqrt(-2.0 * log(unit(c[2]))) * cos(TWO_PI * unit(c[3]));
}

/* --- paths --- */

typedef struct { double along, cross_track, course; } foot;

static inline foot foot_on(const segment *path, int k, double north, double east, double arc) {
  const segment *s = path + k;
  double n = north - s->north, e = east - s->east, c = s->curvature;
  double x = n * s->cosine + e * s->sine, y = e * s->cosine - n * s->sine;
  if (c == 0.0) return (foot){x, y, s->course};
  double to_center = sqrt(square(c * x) + square(1.0 - c * y)), turning = fabs(c), was = arc - s->arc_start;
  if (k > 0 && was < 0.0) was = 0.0;
  else if (k < SEGMENTS - 1 && was > s->length) was = s->length;
  double turned = to_center > AT_CENTER ? atan2(turning * x, 1.0 - c * y) : turning * was;
  double along = was + wrap(turned - turning * was) / turning;
  return (foot){along, (2.0 * y - c * (x * x + y * y)) / (1.0 + to_center), s->course + (c > 0.0 ? turned : -turned)};
}

static inline on_path project(const segment *path, double north, double east, place *at) {
  int k = at->segment, may_return = 1;
  foot f = foot_on(path, k, north, east, at->arc);
  for (int move = 0; move < MOVES; move++) {
    int onward = f.along > path[k].length && k < SEGMENTS - 1, back = f.along < 0.0 && k > 0 && may_return;
    if (!(onward || back)) break;
    may_return = may_return && f.along <= path[k].length;
    k += onward ? 1 : -1;
    f = foot_on(path, k, north, east, at->arc);
  }
  const segment *s = path + k;
  double along = f.along;
  if (k > 0 && along < 0.0) along = 0.0;
  else if (k < SEGMENTS - 1 && along > s->length) along = s->length;
  at->segment = k;
  at->arc = s->arc_start + along;
  return (on_path){wrap(f.course), s->curvature, f.cross_track, s->reference_start + along * s->reference_rate,
                   s->stretch, k == SEGMENTS - 1 && along >= s->length};
}

static inline void point_of_formation(const segment *path, double gamma, int k, double point[2]) {
  while (k < SEGMENTS - 1 && path[k + 1].reference_start <= gamma) k++;
  while (k > 0 && path[k].reference_start > gamma) k--;
  const segment *s = path + k;
  double x = (gamma - s->reference_start) * s->stretch, y = 0.0;
  if (s->curvature != 0.0) {
    double sine, cosine, diameter = 2.0 / s->curvature;
    sincos(0.5 * wrap(s->curvature * x), &sine, &cosine);
    x = diameter * sine * cosine;
    y = diameter * sine * sine;
  }
  point[0] = s->north + x * s->cosine - y * s->sine;
  point[1] = s->east + x * s->sine + y * s->cosine;
}

/* --- on board --- */

static inline void sight(const segment *path, vehicle *me, int other, double reading[3], double velocity[2], double time) {
  double age = USBL_LATENCY * TICK, s_a, c_a, s_e, c_e, s, c;
  sincos(reading[1], &s_a, &c_a);
  sincos(reading[2], &s_e, &c_e);
  sincos(me->now.heading - me->now.yaw_rate * age, &s, &c);
  double level = reading[0] * c_e, ahead = level * c_a, across = level * s_a;
  double north = c * ahead - s * across + me->position[0] - age * velocity[0];
  double east = s * ahead + c * across + me->position[1] - age * velocity[1];
  news *n = me->others + other;
  sighting *seen = me->seen + other;
  n->state = project(path, north, east, &seen->place).gamma;
  if (!n->known) n->speed = SPEED;
  n->valid = seen->time = time - age;
  n->known = n->fresh = 1;
  seen->north = north;
  seen->east = east;
}

static inline void learn(news *mine, double state, double speed, double valid) {
  if (valid > mine->valid) {
    mine->state = state;
    mine->speed = speed;
    mine->valid = valid;
    mine->known = mine->fresh = 1;
  }
}

/* a state less the mean of those that its vehicle hears, the last of them `me` where it is another's */
static inline double disagreement(const news *others, int of, int me, double state, double own) {
  double total = 0.0;
  int count = 0;
  for (int j = 0; j < VEHICLES; j++) {
    if (j == of) continue;
    if (j == me) total += own, count++;
    else if (others[j].has_view) total += others[j].predicted, count++;
  }
  return count ? state - total / count : 0.0;
}

static inline void decide(const common *all, const mission *m, vehicle *fleet, int i, uint32_t tick, double time) {
  vehicle *v = fleet + i;
  const state *now = &v->now;
  double noise[3];
  /* sensors: exact but for the log of those under water */
  v->surge = now->surge;
  v->sway = now->sway;
  if (i != SURFACE) {
    normals(m->seed, tick, all->log, all->ids[i][0], all->ids[i][1], 0, noise);
    v->surge += LOG_BIAS + LOG_SIGMA * noise[0];
    v->sway += LOG_BIAS + LOG_SIGMA * noise[1];
  }
  /* messages that arrive */
  for (int j = 0; j < VEHICLES; j++) {
    v->hears[j] = v->arrives[j] <= time;
    if (v->hears[j]) {
      double age = time - fleet[j].outbox.valid;
      v->arrives[j] = NEVER;
      v->sums[DELIVERED] += 1.0;
      v->sums[AGE_SUM] += age;
      if (age > v->sums[AGE_MAX]) v->sums[AGE_MAX] = age;
    }
  }
  /* position: known, or reckoned and reset by fixes */
  double s, c;
  sincos(now->heading, &s, &c);
  double north = c * v->surge - s * v->sway, east = s * v->surge + c * v->sway;
  double drift[2] = {v->current[0], v->current[1]}; /* as of the last tick */
  if (i == SURFACE) {
    v->position[0] = now->north;
    v->position[1] = now->east;
  } else {
    const sighting *fix = fleet[SURFACE].outbox.seen + i;
    v->position[0] = v->reckoned[0];
    v->position[1] = v->reckoned[1];
    if (v->hears[SURFACE] && fix->time > v->time_of_fix + SAME) {
      v->position[0] = fix->north;
      v->position[1] = fix->east;
      v->time_of_fix = fix->time;
    }
    double s_m, c_m;
    sincos(now->heading + 0.5 * TICK * now->yaw_rate, &s_m, &c_m);
    v->reckoned[0] = v->position[0] + TICK * (c_m * v->surge - s_m * v->sway + drift[0]);
    v->reckoned[1] = v->position[1] + TICK * (s_m * v->surge + c_m * v->sway + drift[1]);
  }
  /* current */
  if (!v->observes) {
    v->observes = 1;
    v->observed[0] = v->position[0];
    v->observed[1] = v->position[1];
  }
  double moves[2] = {north, east};
  for (int k = 0; k < 2; k++) {
    double error = v->position[k] - v->observed[k];
    v->current[k] = v->observed_current[k];
    v->observed[k] += TICK * (K1 * error + moves[k] + v->observed_current[k]);
    v->observed_current[k] += TICK * K2 * error;
  }
  /* on the path */
  on_path p = project(all->paths[i], v->position[0], v->position[1], &v->place);
  double s_p, c_p;
  sincos(p.course, &s_p, &c_p);
  double room = 1.0 - p.curvature * p.cross_track;
  if (room < NEAREST_CENTER) room = NEAREST_CENTER;
  v->path_speed = (c_p * (north + v->current[0]) + s_p * (east + v->current[1])) / (room * p.stretch);
  v->cross_track = p.cross_track;
  v->gamma = p.gamma;
  v->finished |= p.finished;
  /* the others: seen, heard, predicted */
  for (int j = 0; j < VEHICLES; j++) v->others[j].fresh = 0;
  if (i == SURFACE && tick % USBL_PERIOD == USBL_LATENCY) {
    double velocity[2] = {north + drift[0], east + drift[1]};
    for (int j = 0; j < SURFACE; j++) {
      double dn = fleet[j].before.north - v->before.north, de = fleet[j].before.east - v->before.east, s_b, c_b;
      sincos(v->before.heading, &s_b, &c_b);
      double ahead = c_b * dn + s_b * de, across = c_b * de - s_b * dn, level = ahead * ahead + across * across;
      double range = sqrt(level + DEPTH * DEPTH);
      normals(m->seed, tick - USBL_LATENCY, all->usbl, all->ids[i][0], all->ids[j][0], 1, noise);
      double measured = range + RANGE_SIGMA * noise[0];
      double reading[3] = {measured > 0.0 ? measured : 0.0, atan2(across, ahead) + ANGLE_SIGMA * noise[1],
                           atan2(DEPTH, sqrt(level)) + ANGLE_SIGMA * noise[2]};
      if (range <= FARTHEST) sight(all->paths[j], v, j, reading, velocity, time);
    }
  }
  for (int k = 0; k < VEHICLES; k++)
    for (int j = 0; j < VEHICLES; j++)
      if (k != i && v->hears[j]) {
        const message *said = &fleet[j].outbox;
        if (j == k) learn(v->others + k, said->state, said->speed, said->valid);
        else if (j == SURFACE) learn(v->others + k, said->told[k].state, said->told[k].speed, said->told[k].valid);
      }
  double own_before = v->gamma - TICK * v->path_speed;
  for (int k = 0; k < VEHICLES; k++)
    if (k != i) {
      news *n = v->others + k;
      n->correction = 0.0;
      if (n->has_view) n->correction = -GAIN * tanh(disagreement(v->others, k, i, n->predicted, own_before));
    }
  for (int k = 0; k < VEHICLES; k++)
    if (k != i) {
      news *n = v->others + k;
      n->predicted = n->fresh ? n->state + n->speed * (time - n->valid) : n->predicted + TICK * (SPEED + n->correction);
      n->has_view = n->known;
    }
  /* coordinate, guide, compensate */
  v->correction = -GAIN * tanh(disagreement(v->others, i, i, v->gamma, v->gamma));
  double along = p.stretch * (SPEED + v->correction), s_d, c_d;
  if (along < 0.0) along = 0.0;
  v->course = p.course + atan2(-v->cross_track, m->lookahead);
  sincos(v->course, &s_d, &c_d);
  double with = c_d * drift[0] + s_d * drift[1], across = c_d * drift[1] - s_d * drift[0], through = fabs(v->surge);
  if (through < LEAST_SPEED) through = LEAST_SPEED;
  v->heading = v->course - asin(clip(across / through, -MOST_CRAB, MOST_CRAB));
  v->speed = sqrt(square(along - with) + across * across);
  /* speak */
  v->sends = time - v->last_sent > PERIOD - 0.5 * TICK && time > SPEAKS_FROM[i] - 0.5 * TICK;
  if (v->sends) {
    v->last_sent = time;
    v->outbox.valid = time;
    v->outbox.state = v->gamma;
    v->outbox.speed = v->path_speed;
    if (i == SURFACE)
      for (int j = 0; j < SURFACE; j++) v->outbox.seen[j] = v->seen[j], v->outbox.told[j] = v->others[j];
    v->sums[SENT] += 1.0;
  }
}

/* --- sound --- */

static inline double depth_of(int i) { return i == SURFACE ? 0.0 : DEPTH; }
static inline double apart_squared(const vehicle *fleet, int i, int j) {
  return square(fleet[j].now.north - fleet[i].now.north) + square(fleet[j].now.east - fleet[i].now.east)
         + square(depth_of(j) - depth_of(i));
}

static inline void carry(const common *all, const mission *m, vehicle *fleet, uint32_t tick, double time, results *out) {
  for (int i = 0; i < VEHICLES; i++)
    for (int j = 0; j < VEHICLES; j++)
      if (j != i && fleet[j].sends) {
        double arrives = time + (DELAY + sqrt(apart_squared(fleet, i, j)) / SOUND_SPEED);
        int lost = uniform(m->seed, tick, all->link, all->ids[i][0], all->ids[j][0]) < m->loss;
        fleet[i].arrives[j] = lost ? NEVER : arrives;
        double *row = out->messages + MESSAGE_COLUMNS * out->num_messages++;
        row[M_SENT] = time;
        row[M_RECEIVED] = lost ? NAN : arrives;
        row[M_SENDER] = j;
        row[M_RECEIVER] = i;
        row[M_LOST] = lost;
        row[M_VALIDITY] = fleet[j].outbox.valid;
      }
}

/* --- log and metrics --- */

static void record(const vehicle *fleet, const double water[2], results *out) {
  for (int i = 0; i < VEHICLES; i++) {
    const vehicle *v = fleet + i;
    double *row = out->log + (out->num_records * VEHICLES + i) * CHANNELS, s, c;
    sincos(v->now.heading, &s, &c);
    double north = c * v->now.surge - s * v->now.sway + water[0], east = s * v->now.surge + c * v->now.sway + water[1];
    row[L_NORTH] = v->now.north;
    row[L_EAST] = v->now.east;
    row[L_DEPTH] = row[L_DEPTH_DESIRED] = depth_of(i);
    row[L_ALONG_TRACK] = row[L_SHAFT_SPEED] = 0.0;
    row[L_HEADING] = v->now.heading;
    row[L_SURGE] = v->now.surge;
    row[L_SWAY] = v->now.sway;
    row[L_YAW_RATE] = v->now.yaw_rate;
    row[L_COURSE] = atan2(east, north);
    row[L_SPEED] = sqrt(north * north + east * east);
    row[L_CURRENT_NORTH] = water[0];
    row[L_CURRENT_EAST] = water[1];
    row[L_CROSS_TRACK] = v->truth.cross_track;
    row[L_PATH_COURSE] = v->truth.course;
    row[L_CURVATURE] = v->truth.curvature;
    row[L_STATE] = v->truth.gamma;
    row[L_THRUST] = v->thrust;
    row[L_YAW_MOMENT] = v->moment;
    row[L_ALTITUDE] = NAN;
    row[L_NORTH_ESTIMATE] = v->position[0];
    row[L_EAST_ESTIMATE] = v->position[1];
    row[L_CURRENT_NORTH_ESTIMATE] = v->current[0];
    row[L_CURRENT_EAST_ESTIMATE] = v->current[1];
    row[L_CROSS_TRACK_ESTIMATE] = v->cross_track;
    row[L_STATE_ESTIMATE] = v->gamma;
    row[L_COURSE_DESIRED] = v->course;
    row[L_HEADING_DESIRED] = v->heading;
    row[L_SPEED_DESIRED] = v->speed;
    row[L_SPEED_CORRECTION] = v->correction;
    row[L_PHASE] = GO;
    for (int j = 0; j < VEHICLES; j++)
      out->predictions[(out->num_records * VEHICLES + i) * VEHICLES + j] =
          v->others[j].has_view ? v->others[j].predicted : NAN;
  }
  out->num_records++;
}

static inline void tally(results *out, int i, int which, double size) {
  int bin = (int)(BINS * (size / (1.0 + size)));
  out->histograms[(i * HISTOGRAMS + which) * BINS + (bin < BINS ? bin : BINS - 1)] += 1.0;
}

static inline void score(vehicle *v, int i, const double water[2], double time, results *out) {
  double *sums = v->sums, error = fabs(v->truth.cross_track);
  v->below = error < THRESHOLD ? v->below + TICK : 0.0;
  if (sums[SETTLED] == 0.0 && v->below >= HOLD - 0.5 * TICK) {
    double then = time - HOLD + TICK;
    sums[SETTLED] = 1.0;
    sums[SETTLING_TIME] = then > 0.0 ? then : 0.0;
    v->first_state = v->truth.gamma;
  }
  if (sums[SETTLED] != 0.0 && !v->truth.finished) {
    int on_arc = v->truth.curvature != 0.0;
    sums[on_arc ? ARC_TIME : LINE_TIME] += TICK;
    sums[on_arc ? ARC_SQUARES : LINE_SQUARES] += TICK * error * error;
    if (error > sums[CROSS_TRACK_MAX]) sums[CROSS_TRACK_MAX] = error;
    sums[PROGRESS] = v->truth.gamma - v->first_state;
    tally(out, i, CROSS_TRACK_BINS, error);
  }
  sums[FLOWN] += TICK;
  sums[POSITION_SQUARES] += TICK * (square(v->position[0] - v->now.north) + square(v->position[1] - v->now.east));
  sums[CURRENT_SQUARES] += TICK * (square(v->current[0] - water[0]) + square(v->current[1] - water[1]));
  sums[ENERGY] += TICK * v->power;
  sums[YAW_EFFORT] += TICK * square((v->now.yaw_rate - v->last_yaw_rate) * (1.0 / TICK));
  v->last_yaw_rate = v->now.yaw_rate;
  if (!v->truth.finished) sums[ABSOLUTE_ERROR] += TICK * error;
}

static inline void score_fleet(const common *all, vehicle *fleet, results *out) {
  double lowest = fleet[0].truth.gamma, highest = lowest, total = 0.0, nearest = out->fleet[SEPARATION_SQUARED];
  int counts = 1;
  for (int i = 0; i < VEHICLES; i++) {
    double gamma = fleet[i].truth.gamma;
    if (gamma < lowest) lowest = gamma;
    if (gamma > highest) highest = gamma;
    total += gamma;
    counts = counts && fleet[i].sums[SETTLED] != 0.0 && !fleet[i].truth.finished;
    for (int j = 0; j < i; j++) {
      double apart = apart_squared(fleet, i, j);
      if (apart < nearest) nearest = apart;
    }
  }
  out->fleet[SEPARATION_SQUARED] = nearest;
  if (!counts) return;
  double spread = highest - lowest, north = 0.0, east = 0.0;
  out->fleet[TIME] += TICK;
  out->fleet[COORDINATION_SQUARES] += TICK * spread * spread;
  if (spread > out->fleet[COORDINATION_MAX]) out->fleet[COORDINATION_MAX] = spread;
  for (int i = 0; i < VEHICLES; i++) {
    vehicle *v = fleet + i;
    double point[2];
    point_of_formation(all->paths[i], total / VEHICLES, v->true_place.segment, point);
    v->away[0] = v->now.north - point[0];
    v->away[1] = v->now.east - point[1];
    north += v->away[0];
    east += v->away[1];
  }
  for (int i = 0; i < VEHICLES; i++) {
    vehicle *v = fleet + i;
    double squared = square(v->away[0]) + square(v->away[1]);
    v->sums[FORMATION_TIME] += TICK;
    v->sums[FORMATION_SQUARES] += TICK * squared;
    v->sums[RELATIVE_SQUARES] += TICK * (square(v->away[0] - north / VEHICLES) + square(v->away[1] - east / VEHICLES));
    tally(out, i, FORMATION_BINS, sqrt(squared));
  }
}

/* --- motion --- */

static inline state rates(state x, double push, double twist, const double water[2]) {
  double s, c;
  sincos(x.heading, &s, &c);
  return (state){
      c * x.surge - s * x.sway + water[0],
      s * x.surge + c * x.sway + water[1],
      x.yaw_rate,
      push + SWAY_MASS / SURGE_MASS * (x.sway * x.yaw_rate)
          - (SURGE_DRAG / SURGE_MASS + SURGE_DRAG_QUADRATIC / SURGE_MASS * fabs(x.surge)) * x.surge,
      -(SURGE_MASS / SWAY_MASS) * (x.surge * x.yaw_rate)
          - (SWAY_DRAG / SWAY_MASS + SWAY_DRAG_QUADRATIC / SWAY_MASS * fabs(x.sway)) * x.sway,
      twist + (SURGE_MASS - SWAY_MASS) / YAW_INERTIA * (x.surge * x.sway)
          - (YAW_DRAG / YAW_INERTIA + YAW_DRAG_QUADRATIC / YAW_INERTIA * fabs(x.yaw_rate)) * x.yaw_rate};
}
static inline state moved(state x, state k, double dt) {
  return (state){x.north, x.east, x.heading + dt * k.heading, x.surge + dt * k.surge, x.sway + dt * k.sway,
                 x.yaw_rate + dt * k.yaw_rate};
}

static inline void move(vehicle *v, const double water[2]) {
  state x = v->now;
  double heading = x.heading, yaw_rate = x.yaw_rate;
  v->before = x;
  for (int step = 0; step < SUBSTEPS; step++) {
    double error = v->speed - v->surge;
    double thrust = clip(SURGE_DRAG_QUADRATIC * v->speed * v->speed + SPEED_GAIN * error + INTEGRAL_GAIN * v->integral,
                         -THRUST_MAX, THRUST_MAX);
    double moment = clip(HEADING_GAIN * wrap(v->heading - (heading + yaw_rate * (step * STEP)))
                             - YAW_RATE_GAIN * yaw_rate, -MOMENT_MAX, MOMENT_MAX);
    v->integral = clip(v->integral + STEP * error, -INTEGRAL_MAX, INTEGRAL_MAX);
    double push = thrust * (1.0 / SURGE_MASS), twist = moment * (1.0 / YAW_INERTIA);
    state k1 = rates(x, push, twist, water), k2 = rates(moved(x, k1, 0.5 * STEP), push, twist, water);
    state k3 = rates(moved(x, k2, 0.5 * STEP), push, twist, water), k4 = rates(moved(x, k3, STEP), push, twist, water);
#define ADVANCE(f) x.f += STEP / 6.0 * (k1.f + 2.0 * (k2.f + k3.f) + k4.f)
    ADVANCE(north);
    ADVANCE(east);
    ADVANCE(heading);
    ADVANCE(surge);
    ADVANCE(sway);
    ADVANCE(yaw_rate);
    v->thrust = thrust;
    v->moment = moment;
    v->power = fabs(thrust * x.surge) + fabs(moment * x.yaw_rate);
  }
  v->now = x;
}

static int is_ill(const vehicle *v) {
  double all = v->now.north + v->now.east + v->now.heading + v->now.surge + v->now.sway
               + v->heading + v->speed + v->position[0] + v->position[1];
  return !(all - all == 0.0);
}

static void start(vehicle *v, const common *all, int i) {
  memset(v, 0, sizeof *v);
  v->now = (state){all->starts[i][0], all->starts[i][1], all->starts[i][2], all->starts[i][3], 0.0, 0.0};
  v->reckoned[0] = v->now.north;
  v->reckoned[1] = v->now.east;
  v->time_of_fix = v->last_sent = LONG_AGO;
  for (int j = 0; j < VEHICLES; j++) {
    v->arrives[j] = NEVER;
    v->others[j].valid = v->outbox.told[j].valid = LONG_AGO;
    v->seen[j].time = v->outbox.seen[j].time = LONG_AGO;
  }
}

static void fly(const common *all, const mission *m, long ticks, results out) {
  vehicle fleet[VEHICLES];
  double water[2] = {m->current_speed * cos(m->current_towards), m->current_speed * sin(m->current_towards)};
  for (int i = 0; i < VEHICLES; i++) start(fleet + i, all, i);
  memset(out.fleet, 0, FLEET_SUMS * sizeof(double));
  memset(out.histograms, 0, VEHICLES * HISTOGRAMS * BINS * sizeof(double));
  out.fleet[SEPARATION_SQUARED] = NEVER;
  out.fleet[FAILED_AT] = -1.0;
  for (uint32_t tick = 0; tick < ticks; tick++) {
    double time = tick * TICK;
    for (int i = 0; i < VEHICLES; i++) {
      vehicle *v = fleet + i;
      int finished = v->truth.finished;
      v->truth = project(all->paths[i], v->now.north, v->now.east, &v->true_place);
      v->truth.finished |= finished;
    }
    for (int i = 0; i < VEHICLES; i++) decide(all, m, fleet, i, tick, time);
    carry(all, m, fleet, tick, time, &out);
    if (tick % TICKS_PER_RECORD == 0) record(fleet, water, &out);
    for (int i = 0; i < VEHICLES; i++) score(fleet + i, i, water, time, &out);
    score_fleet(all, fleet, &out);
    for (int i = 0; i < VEHICLES; i++) move(fleet + i, water);
    for (int i = 0; i < VEHICLES; i++)
      if (is_ill(fleet + i)) {
        out.fleet[FAILED_AT] = time;
        tick = ticks;
      }
  }
  for (int i = 0; i < VEHICLES; i++) {
    fleet[i].sums[NORTH] = fleet[i].now.north;
    fleet[i].sums[EAST] = fleet[i].now.east;
    fleet[i].sums[HEADING] = fleet[i].now.heading;
    memcpy(out.vehicles + i * VEHICLE_SUMS, fleet[i].sums, sizeof fleet[i].sums);
  }
}

/* Fly missions on threads; each mission's results follow those of the one before. */
void fly_all(long count, int threads, long ticks, long message_room, const common *all, const mission *missions,
             results out) {
  long records = (ticks + TICKS_PER_RECORD - 1) / TICKS_PER_RECORD;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (long k = 0; k < count; k++) {
    results mine = {out.vehicles + k * VEHICLES * VEHICLE_SUMS, out.fleet + k * FLEET_SUMS,
                    out.histograms + k * VEHICLES * HISTOGRAMS * BINS, out.log + k * records * VEHICLES * CHANNELS,
                    out.predictions + k * records * VEHICLES * VEHICLES, out.messages + k * message_room * MESSAGE_COLUMNS,
                    0, 0};
    fly(all, missions + k, ticks, mine);
  }
}
