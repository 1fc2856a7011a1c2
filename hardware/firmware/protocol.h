/* The numbers of PROTOCOL.md, in the order of its tables. */
#ifndef PROTOCOL_H
#define PROTOCOL_H

#define PROTOCOL_VERSION 2
#define FIRMWARE_MAJOR 2
#define FIRMWARE_MINOR 0

#define BAUD 250000UL

/* Frames to the controller: orders, which by-pass the queue, and the two that are sequenced. */
enum {
    HELLO = 0x01, CONFIG = 0x02, ARM = 0x03, START = 0x04, HOLD = 0x05,
    STOP = 0x06, CLEAR = 0x07, PING = 0x08, OFF = 0x09, RECALL = 0x0A,
    KEY = 0x10, END = 0x11
};

/* Frames to the host. */
enum { INFO = 0x81, STATUS = 0x82, RECORD = 0x83 };

enum state { STATE_OFF, STATE_ARMING, STATE_READY, STATE_RUN, STATE_HOLD, STATE_UNDERRUN, STATE_FAULT };

enum fault { FAULT_NONE, FAULT_STOPPED, FAULT_SILENCE, FAULT_BAD_KEY };

enum result { DONE, REFUSED_STATE, REFUSED_LENGTH, REFUSED_RANGE, REFUSED_EMPTY, REFUSED_TYPE };

/* A bit of STATUS: since the last one a frame was damaged or missing. */
#define FLAG_GAP 0x01

#define MAX_CHANNELS 8
#define DEFAULT_CHANNELS 5

/* Pulses on the line are in 1/16 us; Timer1 counts in 1/2 us. */
#define SHORTEST_PULSE (400 * 16U)
#define LONGEST_PULSE (2600 * 16U)
#define TICKS_PER_MS 2000UL
#define TICKS_PER_DURATION 200UL /* a key frame's duration is in 0.1 ms */

#define PULSE_PERIOD_TICKS (20 * TICKS_PER_MS)
#define SLOT_MARGIN_US 100U /* between the end of the longest pulse and the next one */

#define QUEUE_WORDS 384
#define QUEUE_MOST 64

#define ATTACH_TICKS (150 * TICKS_PER_MS)   /* between two servos, so that their surges do not add up */
#define RAMP_TICKS (200 * TICKS_PER_MS)     /* of the time scale from standing to full or back */
#define RESERVE_TICKS (110 * TICKS_PER_MS)  /* queued time below which it brakes: what the ramp down plays, and more */
#define SILENCE_TICKS (5000 * TICKS_PER_MS) /* of a host that is taken for gone */

/* type, sequence number, payload of CONFIG for all channels, CRC; one more byte of stuffing, one delimiter */
#define LONGEST_BODY (2 + 6 * MAX_CHANNELS + 2)
#define LONGEST_FRAME (LONGEST_BODY + 2)

#endif
