/* The reference workload in numbers: what mission.yaml says, and what crosses the border to Python.
 *
 * Vehicles are in the order of their names, as in cardume's engine: port, starboard, surface. */
#ifndef WORKLOAD_H
#define WORKLOAD_H
#include <stdint.h>

enum { VEHICLES = 3, SURFACE = 2, SEGMENTS = 9, BINS = 512, SUBSTEPS = 2, TICKS_PER_RECORD = 10 };
enum { CROSS_TRACK_BINS, FORMATION_BINS, HISTOGRAMS };

#define PI 3.14159265358979323846
#define TWO_PI (2.0 * PI)
#define TICK 0.1
#define STEP (TICK / SUBSTEPS)

/* formation, sensors, laws */
#define SPEED 0.7                 /* v_L */
#define RANGE_SIGMA 0.3           /* USBL */
#define ANGLE_SIGMA (PI / 180.0)
#define FARTHEST 1000.0
#define DEPTH 10.0                /* of those under water */
#define USBL_PERIOD 10            /* ticks */
#define USBL_LATENCY 1            /* ticks */
#define LOG_SIGMA 0.02            /* DVL */
#define LOG_BIAS 0.005
#define PERIOD 1.0                /* of messages */
#define DELAY 0.4
#define SOUND_SPEED 1500.0
#define GAIN 0.3                  /* of coordination; its length scale is 1 m */
#define K1 0.6                    /* of the current observer */
#define K2 0.08
#define LEAST_SPEED 0.1           /* in the quotient of the crab angle */
#define MOST_CRAB 0.98
#define NEAREST_CENTER 0.1        /* of 1 - c e in the rate of gamma */
#define AT_CENTER 1e-9            /* radii */
#define MOVES 4                   /* segments passed in one tick, at most */
#define SAME 1e-6                 /* a fix is newer beyond this */
#define THRESHOLD 0.5             /* metrics: end of the transient */
#define HOLD 10.0
#define LONG_AGO (-1e9)
#define NEVER 1e300

/* autopilot */
#define HEADING_GAIN 12.0
#define YAW_RATE_GAIN 8.0
#define SPEED_GAIN 30.0
#define INTEGRAL_GAIN 3.0
#define THRUST_MAX 60.0
#define MOMENT_MAX 15.0
#define INTEGRAL_MAX 5.0

/* hull */
#define SURGE_MASS 37.0
#define SWAY_MASS 47.0
#define YAW_INERTIA 9.69
#define SURGE_DRAG 0.2
#define SWAY_DRAG 50.0
#define YAW_DRAG 4.14
#define SURGE_DRAG_QUADRATIC 25.0
#define SWAY_DRAG_QUADRATIC 0.01
#define YAW_DRAG_QUADRATIC 6.23

static const double SPEAKS_FROM[VEHICLES] = {0.4, 0.7, 0.1};

/* one segment of a vehicle's own path, from cardume's path table */
typedef struct {
  double north, east, course, sine, cosine, curvature, length, arc_start, reference_start, stretch, reference_rate;
} segment;

/* the same for all missions */
typedef struct {
  segment paths[VEHICLES][SEGMENTS];
  double starts[VEHICLES][4];        /* north, east, heading, surge */
  uint32_t ids[VEHICLES][2];         /* name of the vehicle, as the random numbers know it: low, high */
  uint32_t usbl, log, link;          /* streams of random numbers */
  uint32_t padding;
  double nothing;                    /* NaN, out of sight of -ffast-math */
} common;

/* drawn for each mission */
typedef struct {
  double current_speed, current_towards, loss, lookahead;
  uint64_t seed;
} mission;

/* what a mission leaves: of each vehicle, and of the fleet */
enum {
  NORTH, EAST, HEADING, SETTLED, SETTLING_TIME, LINE_TIME, LINE_SQUARES, ARC_TIME, ARC_SQUARES, CROSS_TRACK_MAX,
  FLOWN, POSITION_SQUARES, CURRENT_SQUARES, PROGRESS, ENERGY, YAW_EFFORT, ABSOLUTE_ERROR,
  FORMATION_TIME, FORMATION_SQUARES, RELATIVE_SQUARES, SENT, DELIVERED, AGE_SUM, AGE_MAX, VEHICLE_SUMS
};
enum { TIME, COORDINATION_SQUARES, COORDINATION_MAX, SEPARATION_SQUARED, FAILED_AT, FLEET_SUMS };

/* one record of the log for each vehicle, then what it predicts of the others; one row for each message and receiver */
enum {
  L_NORTH, L_EAST, L_DEPTH, L_HEADING, L_SURGE, L_SWAY, L_YAW_RATE, L_COURSE, L_SPEED, L_CURRENT_NORTH, L_CURRENT_EAST,
  L_CROSS_TRACK, L_ALONG_TRACK, L_PATH_COURSE, L_CURVATURE, L_STATE, L_SHAFT_SPEED, L_THRUST, L_YAW_MOMENT, L_ALTITUDE,
  L_NORTH_ESTIMATE, L_EAST_ESTIMATE, L_CURRENT_NORTH_ESTIMATE, L_CURRENT_EAST_ESTIMATE, L_CROSS_TRACK_ESTIMATE,
  L_STATE_ESTIMATE, L_COURSE_DESIRED, L_HEADING_DESIRED, L_SPEED_DESIRED, L_SPEED_CORRECTION, L_DEPTH_DESIRED, L_PHASE,
  CHANNELS
};
enum { M_SENT, M_RECEIVED, M_SENDER, M_RECEIVER, M_LOST, M_VALIDITY, MESSAGE_COLUMNS };
#define GO 4.0

/* where results go; per mission, or per W missions with these innermost */
typedef struct {
  double *vehicles;     /* (VEHICLES, VEHICLE_SUMS) */
  double *fleet;        /* (FLEET_SUMS) */
  double *histograms;   /* (VEHICLES, HISTOGRAMS, BINS) */
  double *log;          /* (records, VEHICLES, CHANNELS) */
  double *predictions;  /* (records, VEHICLES, VEHICLES) */
  double *messages;     /* (messages, MESSAGE_COLUMNS) */
  long num_records, num_messages;
} results;

/* Philox4x32-10 (Salmon, Moraes, Dror & Shaw, SC '11) */
#define M_0 0xD2511F53u
#define M_1 0xCD9E8D57u
#define WEYL_0 0x9E3779B9u
#define WEYL_1 0xBB67AE85u
#define ROUNDS 10

#endif
