/* The reference workload, W missions side by side: the innermost loops run over missions, and gcc turns them into SIMD
 * code with the functions of libmvec.  The same work as scalar.c. */
#include "workload.h"
#include <math.h>
#include <string.h>

#ifndef W
#define W 8
#endif
#define LANES _Pragma("omp simd") for (int l = 0; l < W; l++)
#define SIMD(directive) _Pragma(#directive)
#define ANY(flag) SIMD(omp simd reduction(|:flag)) for (int l = 0; l < W; l++)
#define INLINE static inline __attribute__((always_inline))

typedef double lane[W];
typedef int32_t whole[W];
typedef uint32_t words[W];
enum { S_NORTH, S_EAST, S_COURSE, S_SINE, S_COSINE, S_CURVATURE, S_LENGTH, S_ARC, S_REFERENCE, S_STRETCH, S_RATE, S_WIDTH };

typedef struct { lane north, east, heading, surge, sway, yaw_rate; } state;
typedef struct { whole segment; lane arc; } place;
typedef struct { lane course, curvature, cross_track, gamma, stretch; whole finished; } on_path;
typedef struct { lane state, speed, valid, predicted, correction; whole known, fresh, has_view; } news;
typedef struct { lane north, east, time; place place; } sighting;
typedef struct { lane state, speed, valid; } told;
typedef struct { lane north, east, time; } seen;
typedef struct { lane state, speed; double valid; seen seen[VEHICLES]; told told[VEHICLES]; } message;

typedef struct {
  state now, before;
  place true_place;
  on_path truth;
  lane thrust, moment, power;
  place place;
  lane position[2], reckoned[2], time_of_fix, current[2], observed[2], observed_current[2];
  whole finished;
  lane surge, sway, cross_track, gamma, path_speed, integral;
  double last_sent;
  lane course, heading, speed, correction;
  news others[VEHICLES];
  sighting seen[VEHICLES];
  message outbox;
  lane arrives[VEHICLES];
  double due[VEHICLES];                       /* when the first of a link's lanes arrives */
  whole hears[VEHICLES];
  int any_hears[VEHICLES], sends;
  lane below, first_state, last_yaw_rate, away[2];
  lane sums[VEHICLE_SUMS];
} __attribute__((aligned(64))) vehicle;

typedef struct {
  lane loss, lookahead, water[2];
  words seed_low, seed_high;
} drawn;

INLINE double square(double x) { return x * x; }
INLINE double wrap(double a) { return a - TWO_PI * rint(a * (1.0 / TWO_PI)); }
INLINE double least(double a, double b) { return a < b ? a : b; }
INLINE double most(double a, double b) { return a > b ? a : b; }
INLINE double clip(double x, double low, double high) { return least(most(x, low), high); }
INLINE double unit(uint32_t word) { return ((double)(int32_t)(word ^ 0x80000000u) + 2147483648.5) * 0x1p-32; }

INLINE void philox(const drawn *m, uint32_t tick, uint32_t stream, uint32_t a, uint32_t b, words out[4]) {
  LANES {
    uint32_t c0 = tick, c1 = stream, c2 = a, c3 = b, k0 = m->seed_low[l], k1 = m->seed_high[l];
#pragma GCC unroll 10
    for (int round = 0; round < ROUNDS; round++) {
      uint64_t p0 = (uint64_t)M_0 * c0, p1 = (uint64_t)M_1 * c2;
      c0 = (uint32_t)(p1 >> 32) ^ c1 ^ k0;
      c1 = (uint32_t)p1;
      c2 = (uint32_t)(p0 >> 32) ^ c3 ^ k1;
      c3 = (uint32_t)p0;
      k0 += WEYL_0;
      k1 += WEYL_1;
    }
    out[0][l] = c0;
    out[1][l] = c1;
    out[2][l] = c2;
    out[3][l] = c3;
  }
}
INLINE void normals(const drawn *m, uint32_t tick, uint32_t stream, uint32_t a, uint32_t b, int all, lane n[3]) {
  words u[4];
  philox(m, tick, stream, a, b, u);
  LANES {
    double size = sqrt(-2.0 * log(unit(u[0][l]))), angle = TWO_PI * unit(u[1][l]);
    n[0][l] = size * cos(angle);
    n[1][l] = size * sin(angle);
  }
  if (all) LANES n[2][l] = sqrt(-2.0 * log(unit(u[2][l]))) * cos(TWO_PI * unit(u[3][l]));
}

/* --- paths --- */

typedef struct { lane along, cross_track, course; } foot;

INLINE void foot_on(const double *table, const double *north, const double *east, const place *at, const whole k, foot *f) {
  int curves = 0;
  ANY(curves) curves |= table[k[l] * S_WIDTH + S_CURVATURE] != 0.0;
  LANES {
    const int b = k[l] * S_WIDTH;
    double n = north[l] - table[b + S_NORTH], e = east[l] - table[b + S_EAST];
    double sine = table[b + S_SINE], cosine = table[b + S_COSINE];
    f->along[l] = n * cosine + e * sine;
    f->cross_track[l] = e * cosine - n * sine;
    f->course[l] = table[b + S_COURSE];
  }
  if (curves) LANES {
    const int b = k[l] * S_WIDTH;
    double x = f->along[l], y = f->cross_track[l], c = table[b + S_CURVATURE], length = table[b + S_LENGTH];
    double to_center = sqrt(square(c * x) + square(1.0 - c * y)), turning = c == 0.0 ? 1.0 : fabs(c);
    double was = at->arc[l] - table[b + S_ARC];
    was = k[l] > 0 && was < 0.0 ? 0.0 : was;
    was = k[l] < SEGMENTS - 1 && was > length ? length : was;
    double angle = atan2(turning * x, 1.0 - c * y), turned = to_center > AT_CENTER ? angle : turning * was;
    double along = was + wrap(turned - turning * was) / turning;
    f->along[l] = c == 0.0 ? x : along;
    f->cross_track[l] = (2.0 * y - c * (x * x + y * y)) / (1.0 + to_center);
    f->course[l] += c == 0.0 ? 0.0 : c > 0.0 ? turned : -turned;
  }
}

static void project(const double *table, const double *north, const double *east, place *at, on_path *p) {
  whole k, may_return;
  foot f;
  LANES k[l] = at->segment[l];
  LANES may_return[l] = 1;
  foot_on(table, north, east, at, k, &f);
  for (int move = 0; move < MOVES; move++) {
    int moves = 0;
    whole next;
    ANY(moves) {
      double length = table[k[l] * S_WIDTH + S_LENGTH];
      int onward = (f.along[l] > length) & (k[l] < SEGMENTS - 1);
      int back = (f.along[l] < 0.0) & (k[l] > 0) & may_return[l];
      may_return[l] &= f.along[l] <= length;
      next[l] = k[l] + (onward ? 1 : back ? -1 : 0);
      moves |= onward | back;
    }
    if (!moves) break;
    LANES k[l] = next[l];
    foot_on(table, north, east, at, k, &f);
  }
  LANES {
    const int b = k[l] * S_WIDTH;
    double length = table[b + S_LENGTH], along = f.along[l];
    along = k[l] > 0 && along < 0.0 ? 0.0 : along;
    along = k[l] < SEGMENTS - 1 && along > length ? length : along;
    at->segment[l] = k[l];
    at->arc[l] = table[b + S_ARC] + along;
    p->course[l] = wrap(f.course[l]);
    p->curvature[l] = table[b + S_CURVATURE];
    p->cross_track[l] = f.cross_track[l];
    p->gamma[l] = table[b + S_REFERENCE] + along * table[b + S_RATE];
    p->stretch[l] = table[b + S_STRETCH];
    p->finished[l] = (k[l] == SEGMENTS - 1) & (along >= length);
  }
}

INLINE void point_of_formation(const double *table, const lane gamma, const whole guess, lane point[2]) {
  whole k;
  int curves = 0;
  for (int l = 0; l < W; l++) {
    int s = guess[l];
    while (s < SEGMENTS - 1 && table[(s + 1) * S_WIDTH + S_REFERENCE] <= gamma[l]) s++;
    while (s > 0 && table[s * S_WIDTH + S_REFERENCE] > gamma[l]) s--;
    k[l] = s;
    curves |= table[s * S_WIDTH + S_CURVATURE] != 0.0;
  }
  lane x, y;
  LANES {
    const int b = k[l] * S_WIDTH;
    x[l] = (gamma[l] - table[b + S_REFERENCE]) * table[b + S_STRETCH];
    y[l] = 0.0;
  }
  if (curves) LANES {
    double c = table[k[l] * S_WIDTH + S_CURVATURE], diameter = 2.0 / (c == 0.0 ? 1.0 : c), half = 0.5 * wrap(c * x[l]);
    double s = sin(half), r = cos(half);
    x[l] = c == 0.0 ? x[l] : diameter * s * r;
    y[l] = c == 0.0 ? 0.0 : diameter * s * s;
  }
  LANES {
    const int b = k[l] * S_WIDTH;
    double sine = table[b + S_SINE], cosine = table[b + S_COSINE];
    point[0][l] = table[b + S_NORTH] + x[l] * cosine - y[l] * sine;
    point[1][l] = table[b + S_EAST] + x[l] * sine + y[l] * cosine;
  }
}

/* --- on board --- */

static void look(const common *all, const drawn *m, vehicle *fleet, int j, uint32_t tick, double time, lane velocity[2]) {
  vehicle *v = fleet + SURFACE;
  const state *here = &v->before, *there = &fleet[j].before;
  const double age = USBL_LATENCY * TICK;
  lane noise[3], north, east;
  whole heard;
  normals(m, tick - USBL_LATENCY, all->usbl, all->ids[SURFACE][0], all->ids[j][0], 1, noise);
  LANES {
    double dn = there->north[l] - here->north[l], de = there->east[l] - here->east[l];
    double c = cos(here->heading[l]), s = sin(here->heading[l]);
    double ahead = c * dn + s * de, across = c * de - s * dn, level = ahead * ahead + across * across;
    double range = sqrt(level + DEPTH * DEPTH), measured = most(range + RANGE_SIGMA * noise[0][l], 0.0);
    double azimuth = atan2(across, ahead) + ANGLE_SIGMA * noise[1][l];
    double elevation = atan2(DEPTH, sqrt(level)) + ANGLE_SIGMA * noise[2][l], heading = v->now.heading[l] - v->now.yaw_rate[l] * age;
    double flat = measured * cos(elevation), forward = flat * cos(azimuth), aside = flat * sin(azimuth);
    double ch = cos(heading), sh = sin(heading);
    heard[l] = range <= FARTHEST;
    north[l] = ch * forward - sh * aside + v->position[0][l] - age * velocity[0][l];
    east[l] = sh * forward + ch * aside + v->position[1][l] - age * velocity[1][l];
  }
  news *n = v->others + j;
  sighting *mine = v->seen + j;
  place before = mine->place;
  on_path p;
  project((const double *)all->paths[j], north, east, &mine->place, &p);
  LANES {
    int is = heard[l];
    mine->place.segment[l] = is ? mine->place.segment[l] : before.segment[l];
    mine->place.arc[l] = is ? mine->place.arc[l] : before.arc[l];
    n->state[l] = is ? p.gamma[l] : n->state[l];
    n->speed[l] = is && !n->known[l] ? SPEED : n->speed[l];
    n->valid[l] = is ? time - age : n->valid[l];
    n->known[l] |= is;
    n->fresh[l] = is;
    mine->north[l] = is ? north[l] : mine->north[l];
    mine->east[l] = is ? east[l] : mine->east[l];
    mine->time[l] = is ? time - age : mine->time[l];
  }
}

INLINE void learn(news *mine, const whole hears, const double *said_state, const double *said_speed, const double *valid,
                  double valid_of_all) {
  LANES {
    double then = valid ? valid[l] : valid_of_all;
    int is_new = (hears[l] != 0) & (then > mine->valid[l]);
    mine->state[l] = is_new ? said_state[l] : mine->state[l];
    mine->speed[l] = is_new ? said_speed[l] : mine->speed[l];
    mine->valid[l] = is_new ? then : mine->valid[l];
    mine->known[l] |= is_new;
    mine->fresh[l] |= is_new;
  }
}

INLINE void disagreement(const news *others, int of, int me, const double *state, const double *own, lane apart) {
  lane total, count;
  LANES total[l] = count[l] = 0.0;
  for (int j = 0; j < VEHICLES; j++) {
    if (j == of) continue;
    if (j == me) LANES total[l] += own[l], count[l] += 1.0;
    else LANES {
      total[l] += others[j].has_view[l] ? others[j].predicted[l] : 0.0;
      count[l] += others[j].has_view[l] ? 1.0 : 0.0;
    }
  }
  LANES apart[l] = count[l] > 0.5 ? state[l] - total[l] / most(count[l], 1.0) : 0.0;
}

INLINE void hear(vehicle *fleet, int i, double time) {
  vehicle *v = fleet + i;
  for (int j = 0; j < VEHICLES; j++) {
    v->any_hears[j] = j != i && v->due[j] <= time;
    if (!v->any_hears[j]) continue;
    double age = time - fleet[j].outbox.valid, next = NEVER;
    LANES {
      int here = v->arrives[j][l] <= time;
      v->hears[j][l] = here;
      v->arrives[j][l] = here ? NEVER : v->arrives[j][l];
      v->sums[DELIVERED][l] += here ? 1.0 : 0.0;
      v->sums[AGE_SUM][l] += here ? age : 0.0;
      v->sums[AGE_MAX][l] = here ? most(age, v->sums[AGE_MAX][l]) : v->sums[AGE_MAX][l];
    }
    for (int l = 0; l < W; l++) next = least(next, v->arrives[j][l]);
    v->due[j] = next;
  }
}

static void decide(const common *all, const drawn *m, vehicle *fleet, int i, uint32_t tick, double time) {
  vehicle *v = fleet + i;
  const state *now = &v->now;
  lane noise[3], moves[2], drift[2];
  LANES {
    v->surge[l] = now->surge[l];
    v->sway[l] = now->sway[l];
  }
  if (i != SURFACE) {
    normals(m, tick, all->log, all->ids[i][0], all->ids[i][1], 0, noise);
    LANES {
      v->surge[l] += LOG_BIAS + LOG_SIGMA * noise[0][l];
      v->sway[l] += LOG_BIAS + LOG_SIGMA * noise[1][l];
    }
  }
  hear(fleet, i, time);
  LANES {
    double c = cos(now->heading[l]), s = sin(now->heading[l]);
    moves[0][l] = c * v->surge[l] - s * v->sway[l];
    moves[1][l] = s * v->surge[l] + c * v->sway[l];
    drift[0][l] = v->current[0][l];
    drift[1][l] = v->current[1][l];
  }
  if (i == SURFACE) LANES {
    v->position[0][l] = now->north[l];
    v->position[1][l] = now->east[l];
  }
  else {
    if (v->any_hears[SURFACE]) {
      const seen *fix = fleet[SURFACE].outbox.seen + i;
      LANES {
        int is_new = (v->hears[SURFACE][l] != 0) & (fix->time[l] > v->time_of_fix[l] + SAME);
        v->reckoned[0][l] = is_new ? fix->north[l] : v->reckoned[0][l];
        v->reckoned[1][l] = is_new ? fix->east[l] : v->reckoned[1][l];
        v->time_of_fix[l] = is_new ? fix->time[l] : v->time_of_fix[l];
      }
    }
    LANES {
      double middle = now->heading[l] + 0.5 * TICK * now->yaw_rate[l], c = cos(middle), s = sin(middle);
      v->position[0][l] = v->reckoned[0][l];
      v->position[1][l] = v->reckoned[1][l];
      v->reckoned[0][l] += TICK * (c * v->surge[l] - s * v->sway[l] + drift[0][l]);
      v->reckoned[1][l] += TICK * (s * v->surge[l] + c * v->sway[l] + drift[1][l]);
    }
  }
  for (int k = 0; k < 2; k++) {
    if (tick == 0) LANES v->observed[k][l] = v->position[k][l];
    LANES {
      double error = v->position[k][l] - v->observed[k][l];
      v->current[k][l] = v->observed_current[k][l];
      v->observed[k][l] += TICK * (K1 * error + moves[k][l] + v->observed_current[k][l]);
      v->observed_current[k][l] += TICK * K2 * error;
    }
  }
  on_path p;
  project((const double *)all->paths[i], v->position[0], v->position[1], &v->place, &p);
  lane own_before, apart;
  LANES {
    double c = cos(p.course[l]), s = sin(p.course[l]);
    double room = most(1.0 - p.curvature[l] * p.cross_track[l], NEAREST_CENTER);
    double along = c * (moves[0][l] + v->current[0][l]) + s * (moves[1][l] + v->current[1][l]);
    v->path_speed[l] = along / (room * p.stretch[l]);
    v->cross_track[l] = p.cross_track[l];
    v->gamma[l] = p.gamma[l];
    v->finished[l] |= p.finished[l];
    own_before[l] = p.gamma[l] - TICK * v->path_speed[l];
  }
  for (int k = 0; k < VEHICLES; k++) LANES v->others[k].fresh[l] = 0;
  if (i == SURFACE && tick % USBL_PERIOD == USBL_LATENCY) {
    lane velocity[2];
    LANES {
      velocity[0][l] = moves[0][l] + drift[0][l];
      velocity[1][l] = moves[1][l] + drift[1][l];
    }
    for (int j = 0; j < SURFACE; j++) look(all, m, fleet, j, tick, time, velocity);
  }
  for (int k = 0; k < VEHICLES; k++)
    for (int j = 0; j < VEHICLES; j++)
      if (k != i && v->any_hears[j]) {
        const message *said = &fleet[j].outbox;
        if (j == k) learn(v->others + k, v->hears[j], said->state, said->speed, 0, said->valid);
        else if (j == SURFACE)
          learn(v->others + k, v->hears[j], said->told[k].state, said->told[k].speed, said->told[k].valid, 0.0);
      }
  for (int k = 0; k < VEHICLES; k++)
    if (k != i) {
      news *n = v->others + k;
      disagreement(v->others, k, i, n->predicted, own_before, apart);
      LANES n->correction[l] = n->has_view[l] ? -GAIN * tanh(apart[l]) : 0.0;
    }
  for (int k = 0; k < VEHICLES; k++)
    if (k != i) {
      news *n = v->others + k;
      LANES {
        double known = n->state[l] + n->speed[l] * (time - n->valid[l]);
        n->predicted[l] = n->fresh[l] ? known : n->predicted[l] + TICK * (SPEED + n->correction[l]);
        n->has_view[l] = n->known[l];
      }
    }
  disagreement(v->others, i, i, v->gamma, v->gamma, apart);
  LANES {
    v->correction[l] = -GAIN * tanh(apart[l]);
    double along = most(p.stretch[l] * (SPEED + v->correction[l]), 0.0);
    double course = p.course[l] + atan2(-v->cross_track[l], m->lookahead[l]), c = cos(course), s = sin(course);
    double with = c * drift[0][l] + s * drift[1][l], across = c * drift[1][l] - s * drift[0][l];
    double through = most(fabs(v->surge[l]), LEAST_SPEED);
    v->course[l] = course;
    v->heading[l] = course - asin(clip(across / through, -MOST_CRAB, MOST_CRAB));
    v->speed[l] = sqrt(square(along - with) + across * across);
  }
  v->sends = time - v->last_sent > PERIOD - 0.5 * TICK && time > SPEAKS_FROM[i] - 0.5 * TICK;
  if (v->sends) {
    message *said = &v->outbox;
    v->last_sent = said->valid = time;
    LANES {
      said->state[l] = v->gamma[l];
      said->speed[l] = v->path_speed[l];
      v->sums[SENT][l] += 1.0;
    }
    if (i == SURFACE)
      for (int j = 0; j < SURFACE; j++) LANES {
        said->seen[j].north[l] = v->seen[j].north[l];
        said->seen[j].east[l] = v->seen[j].east[l];
        said->seen[j].time[l] = v->seen[j].time[l];
        said->told[j].state[l] = v->others[j].state[l];
        said->told[j].speed[l] = v->others[j].speed[l];
        said->told[j].valid[l] = v->others[j].known[l] ? v->others[j].valid[l] : LONG_AGO;
      }
  }
}

/* --- sound --- */

INLINE double depth_of(int i) { return i == SURFACE ? 0.0 : DEPTH; }
INLINE double apart_squared(const vehicle *fleet, int i, int j, int l) {
  return square(fleet[j].now.north[l] - fleet[i].now.north[l]) + square(fleet[j].now.east[l] - fleet[i].now.east[l])
         + square(depth_of(j) - depth_of(i));
}

static void carry(const common *all, const drawn *m, vehicle *fleet, uint32_t tick, double time, results *out) {
  for (int i = 0; i < VEHICLES; i++)
    for (int j = 0; j < VEHICLES; j++)
      if (j != i && fleet[j].sends) {
        words u[4];
        double *row = out->messages + MESSAGE_COLUMNS * W * out->num_messages++, due = NEVER;
        const double valid = fleet[j].outbox.valid, nothing = all->nothing;
        double *arrives = fleet[i].arrives[j];
        philox(m, tick, all->link, all->ids[i][0], all->ids[j][0], u);
        LANES {
          double arrival = time + (DELAY + sqrt(apart_squared(fleet, i, j, l)) / SOUND_SPEED);
          int lost = unit(u[0][l]) < m->loss[l];
          arrives[l] = lost ? NEVER : arrival;
          row[M_SENT * W + l] = time;
          row[M_RECEIVED * W + l] = lost ? nothing : arrival;
          row[M_SENDER * W + l] = j;
          row[M_RECEIVER * W + l] = i;
          row[M_LOST * W + l] = lost ? 1.0 : 0.0;
          row[M_VALIDITY * W + l] = valid;
        }
        for (int l = 0; l < W; l++) due = least(due, arrives[l]);
        fleet[i].due[j] = due;
      }
}

/* --- log and metrics --- */

static void record(const common *all, const drawn *m, const vehicle *fleet, results *out) {
  for (int i = 0; i < VEHICLES; i++) {
    const vehicle *v = fleet + i;
    double *row = out->log + (out->num_records * VEHICLES + i) * CHANNELS * W;
    const double depth = depth_of(i), nothing = all->nothing;
#define PUT(channel, value) row[channel * W + l] = value
    LANES {
      double c = cos(v->now.heading[l]), s = sin(v->now.heading[l]);
      double north = c * v->now.surge[l] - s * v->now.sway[l] + m->water[0][l];
      double east = s * v->now.surge[l] + c * v->now.sway[l] + m->water[1][l];
      PUT(L_COURSE, atan2(east, north));
      PUT(L_SPEED, sqrt(north * north + east * east));
    }
    LANES {
      PUT(L_NORTH, v->now.north[l]);
      PUT(L_EAST, v->now.east[l]);
      PUT(L_DEPTH, depth);
      PUT(L_HEADING, v->now.heading[l]);
      PUT(L_SURGE, v->now.surge[l]);
      PUT(L_SWAY, v->now.sway[l]);
      PUT(L_YAW_RATE, v->now.yaw_rate[l]);
      PUT(L_CURRENT_NORTH, m->water[0][l]);
      PUT(L_CURRENT_EAST, m->water[1][l]);
      PUT(L_CROSS_TRACK, v->truth.cross_track[l]);
      PUT(L_ALONG_TRACK, 0.0);
      PUT(L_PATH_COURSE, v->truth.course[l]);
      PUT(L_CURVATURE, v->truth.curvature[l]);
      PUT(L_STATE, v->truth.gamma[l]);
      PUT(L_SHAFT_SPEED, 0.0);
      PUT(L_THRUST, v->thrust[l]);
      PUT(L_YAW_MOMENT, v->moment[l]);
      PUT(L_ALTITUDE, nothing);
      PUT(L_NORTH_ESTIMATE, v->position[0][l]);
      PUT(L_EAST_ESTIMATE, v->position[1][l]);
      PUT(L_CURRENT_NORTH_ESTIMATE, v->current[0][l]);
      PUT(L_CURRENT_EAST_ESTIMATE, v->current[1][l]);
      PUT(L_CROSS_TRACK_ESTIMATE, v->cross_track[l]);
      PUT(L_STATE_ESTIMATE, v->gamma[l]);
      PUT(L_COURSE_DESIRED, v->course[l]);
      PUT(L_HEADING_DESIRED, v->heading[l]);
      PUT(L_SPEED_DESIRED, v->speed[l]);
      PUT(L_SPEED_CORRECTION, v->correction[l]);
      PUT(L_DEPTH_DESIRED, depth);
      PUT(L_PHASE, GO);
    }
    double *predictions = out->predictions + (out->num_records * VEHICLES + i) * VEHICLES * W;
    for (int j = 0; j < VEHICLES; j++)
      LANES predictions[j * W + l] = v->others[j].has_view[l] ? v->others[j].predicted[l] : nothing;
  }
  out->num_records++;
}

INLINE void tally(double *bins, const lane size, const whole counts) {
  whole bin;
  LANES {
    int b = (int)(BINS * (size[l] / (1.0 + size[l])));
    bin[l] = b < BINS ? b : BINS - 1;
  }
  for (int l = 0; l < W; l++)
    if (counts[l]) bins[bin[l] * W + l] += 1.0;
}

static void score(const drawn *m, vehicle *v, int i, double time, results *out) {
  lane *sums = v->sums, size;
  whole counts;
  const double then = most(time - HOLD + TICK, 0.0);
  LANES {
    double error = fabs(v->truth.cross_track[l]), gamma = v->truth.gamma[l];
    double below = error < THRESHOLD ? v->below[l] + TICK : 0.0;
    int ends = (sums[SETTLED][l] == 0.0) & (below >= HOLD - 0.5 * TICK);
    double settled = ends ? 1.0 : sums[SETTLED][l], first = ends ? gamma : v->first_state[l];
    int on = v->truth.finished[l] == 0, counted = (settled != 0.0) & on;
    double dt = counted ? TICK : 0.0;
    int curved = v->truth.curvature[l] != 0.0;
    double on_arc = curved ? dt : 0.0, on_line = curved ? 0.0 : dt;
    v->below[l] = below;
    v->first_state[l] = first;
    sums[SETTLED][l] = settled;
    sums[SETTLING_TIME][l] = ends ? then : sums[SETTLING_TIME][l];
    sums[ARC_TIME][l] += on_arc;
    sums[ARC_SQUARES][l] += on_arc * error * error;
    sums[LINE_TIME][l] += on_line;
    sums[LINE_SQUARES][l] += on_line * error * error;
    sums[CROSS_TRACK_MAX][l] = most(counted ? error : 0.0, sums[CROSS_TRACK_MAX][l]);
    sums[PROGRESS][l] = counted ? gamma - first : sums[PROGRESS][l];
    sums[ABSOLUTE_ERROR][l] += on ? TICK * error : 0.0;
    size[l] = error;
    counts[l] = counted;
  }
  LANES {
    sums[FLOWN][l] += TICK;
    sums[POSITION_SQUARES][l] +=
        TICK * (square(v->position[0][l] - v->now.north[l]) + square(v->position[1][l] - v->now.east[l]));
    sums[CURRENT_SQUARES][l] +=
        TICK * (square(v->current[0][l] - m->water[0][l]) + square(v->current[1][l] - m->water[1][l]));
    sums[ENERGY][l] += TICK * v->power[l];
    sums[YAW_EFFORT][l] += TICK * square((v->now.yaw_rate[l] - v->last_yaw_rate[l]) * (1.0 / TICK));
    v->last_yaw_rate[l] = v->now.yaw_rate[l];
  }
  tally(out->histograms + (i * HISTOGRAMS + CROSS_TRACK_BINS) * BINS * W, size, counts);
}

static void score_fleet(const common *all, vehicle *fleet, results *out) {
  lane mean, north, east;
  whole counts;
  double *f = out->fleet;
  int any = 0;
  ANY(any) {
    double lowest = fleet[0].truth.gamma[l], highest = lowest, total = 0.0, nearest = f[SEPARATION_SQUARED * W + l];
    int counted = 1;
    for (int i = 0; i < VEHICLES; i++) {
      double gamma = fleet[i].truth.gamma[l];
      lowest = least(gamma, lowest);
      highest = most(gamma, highest);
      total += gamma;
      counted &= (fleet[i].sums[SETTLED][l] != 0.0) & (fleet[i].truth.finished[l] == 0);
      for (int j = 0; j < i; j++) nearest = least(apart_squared(fleet, i, j, l), nearest);
    }
    double spread = highest - lowest, dt = counted ? TICK : 0.0;
    f[SEPARATION_SQUARED * W + l] = nearest;
    f[TIME * W + l] += dt;
    f[COORDINATION_SQUARES * W + l] += dt * spread * spread;
    f[COORDINATION_MAX * W + l] = most(counted ? spread : 0.0, f[COORDINATION_MAX * W + l]);
    mean[l] = total * (1.0 / VEHICLES);
    north[l] = east[l] = 0.0;
    counts[l] = counted;
    any |= counted;
  }
  if (!any) return;
  for (int i = 0; i < VEHICLES; i++) {
    vehicle *v = fleet + i;
    lane point[2];
    point_of_formation((const double *)all->paths[i], mean, v->true_place.segment, point);
    LANES {
      v->away[0][l] = v->now.north[l] - point[0][l];
      v->away[1][l] = v->now.east[l] - point[1][l];
      north[l] += v->away[0][l];
      east[l] += v->away[1][l];
    }
  }
  for (int i = 0; i < VEHICLES; i++) {
    vehicle *v = fleet + i;
    lane size;
    LANES {
      double squared = square(v->away[0][l]) + square(v->away[1][l]), dt = counts[l] ? TICK : 0.0;
      v->sums[FORMATION_TIME][l] += dt;
      v->sums[FORMATION_SQUARES][l] += dt * squared;
      v->sums[RELATIVE_SQUARES][l] += dt * (square(v->away[0][l] - north[l] * (1.0 / VEHICLES))
                                            + square(v->away[1][l] - east[l] * (1.0 / VEHICLES)));
      size[l] = sqrt(squared);
    }
    tally(out->histograms + (i * HISTOGRAMS + FORMATION_BINS) * BINS * W, size, counts);
  }
}

/* --- motion --- */

typedef struct { double north, east, heading, surge, sway, yaw_rate; } body;

INLINE body rates(double heading, double u, double v, double r, double push, double twist, double flow_north, double flow_east) {
  double s = sin(heading), c = cos(heading);
  return (body){
      c * u - s * v + flow_north,
      s * u + c * v + flow_east,
      r,
      push + SWAY_MASS / SURGE_MASS * (v * r) - (SURGE_DRAG / SURGE_MASS + SURGE_DRAG_QUADRATIC / SURGE_MASS * fabs(u)) * u,
      -(SURGE_MASS / SWAY_MASS) * (u * r) - (SWAY_DRAG / SWAY_MASS + SWAY_DRAG_QUADRATIC / SWAY_MASS * fabs(v)) * v,
      twist + (SURGE_MASS - SWAY_MASS) / YAW_INERTIA * (u * v)
          - (YAW_DRAG / YAW_INERTIA + YAW_DRAG_QUADRATIC / YAW_INERTIA * fabs(r)) * r};
}

static void move(const drawn *m, vehicle *v) {
  state *x = &v->now;
  v->before = *x;
  for (int step = 0; step < SUBSTEPS; step++) LANES {
    const double h = STEP, yaw_rate = v->before.yaw_rate[l], error = v->speed[l] - v->surge[l];
    const double flow_north = m->water[0][l], flow_east = m->water[1][l];
    double thrust = clip(SURGE_DRAG_QUADRATIC * v->speed[l] * v->speed[l] + SPEED_GAIN * error + INTEGRAL_GAIN * v->integral[l],
                         -THRUST_MAX, THRUST_MAX);
    double aim = wrap(v->heading[l] - (v->before.heading[l] + yaw_rate * (step * STEP)));
    double moment = clip(HEADING_GAIN * aim - YAW_RATE_GAIN * yaw_rate, -MOMENT_MAX, MOMENT_MAX);
    double push = thrust * (1.0 / SURGE_MASS), twist = moment * (1.0 / YAW_INERTIA);
    double p = x->heading[l], u = x->surge[l], s = x->sway[l], r = x->yaw_rate[l];
#define AFTER(k, dt) p + (dt) * k.heading, u + (dt) * k.surge, s + (dt) * k.sway, r + (dt) * k.yaw_rate
    body k1 = rates(p, u, s, r, push, twist, flow_north, flow_east);
    body k2 = rates(AFTER(k1, 0.5 * h), push, twist, flow_north, flow_east);
    body k3 = rates(AFTER(k2, 0.5 * h), push, twist, flow_north, flow_east);
    body k4 = rates(AFTER(k3, h), push, twist, flow_north, flow_east);
#define GAINED(f) (h / 6.0 * (k1.f + 2.0 * (k2.f + k3.f) + k4.f))
    x->north[l] += GAINED(north);
    x->east[l] += GAINED(east);
    x->heading[l] = p + GAINED(heading);
    x->surge[l] = u + GAINED(surge);
    x->sway[l] = s + GAINED(sway);
    x->yaw_rate[l] = r + GAINED(yaw_rate);
    v->integral[l] = clip(v->integral[l] + STEP * error, -INTEGRAL_MAX, INTEGRAL_MAX);
    v->thrust[l] = thrust;
    v->moment[l] = moment;
    v->power[l] = fabs(thrust * x->surge[l]) + fabs(moment * x->yaw_rate[l]);
  }
}

/* the first time at which a number of a lane is none; -ffast-math knows no NaN, so by its bits */
INLINE void check(const vehicle *v, double time, double *failed_at) {
  LANES {
    double all = v->now.north[l] + v->now.east[l] + v->now.heading[l] + v->now.surge[l] + v->now.sway[l] + v->heading[l]
                 + v->speed[l] + v->position[0][l] + v->position[1][l];
    uint64_t bits;
    memcpy(&bits, &all, sizeof bits);
    int ill = (bits & 0x7ff0000000000000u) == 0x7ff0000000000000u;
    failed_at[l] = ill && failed_at[l] < 0.0 ? time : failed_at[l];
  }
}

static void start(vehicle *v, const common *all, int i) {
  memset(v, 0, sizeof *v);
  v->last_sent = LONG_AGO;
  LANES {
    v->now.north[l] = v->reckoned[0][l] = all->starts[i][0];
    v->now.east[l] = v->reckoned[1][l] = all->starts[i][1];
    v->now.heading[l] = all->starts[i][2];
    v->now.surge[l] = all->starts[i][3];
    v->time_of_fix[l] = LONG_AGO;
  }
  for (int j = 0; j < VEHICLES; j++) {
    v->due[j] = NEVER;
    LANES {
      v->arrives[j][l] = NEVER;
      v->others[j].valid[l] = v->seen[j].time[l] = LONG_AGO;
      v->outbox.told[j].valid[l] = v->outbox.seen[j].time[l] = LONG_AGO;
    }
  }
}

static void fly(const common *all, const drawn *m, long ticks, results out) {
  vehicle fleet[VEHICLES];
  for (int i = 0; i < VEHICLES; i++) start(fleet + i, all, i);
  memset(out.fleet, 0, FLEET_SUMS * sizeof(lane));
  memset(out.histograms, 0, VEHICLES * HISTOGRAMS * BINS * sizeof(lane));
  LANES {
    out.fleet[SEPARATION_SQUARED * W + l] = NEVER;
    out.fleet[FAILED_AT * W + l] = -1.0;
  }
  for (uint32_t tick = 0; tick < ticks; tick++) {
    double time = tick * TICK;
    for (int i = 0; i < VEHICLES; i++) {
      vehicle *v = fleet + i;
      whole finished;
      LANES finished[l] = v->truth.finished[l];
      project((const double *)all->paths[i], v->now.north, v->now.east, &v->true_place, &v->truth);
      LANES v->truth.finished[l] |= finished[l];
    }
    for (int i = 0; i < VEHICLES; i++) decide(all, m, fleet, i, tick, time);
    carry(all, m, fleet, tick, time, &out);
    if (tick % TICKS_PER_RECORD == 0) record(all, m, fleet, &out);
    for (int i = 0; i < VEHICLES; i++) score(m, fleet + i, i, time, &out);
    score_fleet(all, fleet, &out);
    for (int i = 0; i < VEHICLES; i++) move(m, fleet + i);
    for (int i = 0; i < VEHICLES; i++) check(fleet + i, time, out.fleet + FAILED_AT * W);
  }
  for (int i = 0; i < VEHICLES; i++) {
    memcpy(fleet[i].sums[NORTH], fleet[i].now.north, sizeof(lane));
    memcpy(fleet[i].sums[EAST], fleet[i].now.east, sizeof(lane));
    memcpy(fleet[i].sums[HEADING], fleet[i].now.heading, sizeof(lane));
    memcpy(out.vehicles + i * VEHICLE_SUMS * W, fleet[i].sums, sizeof fleet[i].sums);
  }
}

/* Fly missions on threads, W in a group; the results of each group follow those of the one before. */
void fly_all(long count, int threads, long ticks, long message_room, const common *all, const mission *missions,
             results out) {
  long records = (ticks + TICKS_PER_RECORD - 1) / TICKS_PER_RECORD;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (long g = 0; g < (count + W - 1) / W; g++) {
    drawn m;
    for (int l = 0; l < W; l++) {
      const mission *one = missions + (g * W + l < count ? g * W + l : count - 1);
      m.loss[l] = one->loss;
      m.lookahead[l] = one->lookahead;
      m.water[0][l] = one->current_speed * cos(one->current_towards);
      m.water[1][l] = one->current_speed * sin(one->current_towards);
      m.seed_low[l] = (uint32_t)one->seed;
      m.seed_high[l] = (uint32_t)(one->seed >> 32);
    }
    results mine = {out.vehicles + g * VEHICLES * VEHICLE_SUMS * W, out.fleet + g * FLEET_SUMS * W,
                    out.histograms + g * VEHICLES * HISTOGRAMS * BINS * W, out.log + g * records * VEHICLES * CHANNELS * W,
                    out.predictions + g * records * VEHICLES * VEHICLES * W,
                    out.messages + g * message_room * MESSAGE_COLUMNS * W, 0, 0};
    fly(all, &m, ticks, mine);
  }
}
