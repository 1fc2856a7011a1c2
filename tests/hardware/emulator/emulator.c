/* The controller without the metal: the firmware in simavr, its line on a pty or in lock-step, its pins in a file.
 *
 *     emulator FIRMWARE.elf PINS.bin --pty LINK                  real time; LINK leads to the pty
 *     emulator FIRMWARE.elf PINS.bin --lockstep                  time passes only as asked on standard input
 *     ... [--flip RATE] [--drop RATE] [--duplicate RATE] [--seed N]   of bytes, both ways
 *
 * PINS.bin: a record (u64 cycle, u8 channel, u8 level, 6 bytes 0) a change of a servo pin, and every few milliseconds
 * one of no channel (255), so that a pin that stays as it is can be told from a time that has not come yet; of level 1
 * where a reset lets go of the pins, which pull-downs then take low.
 * Lock-step: (u32 cycles, u16 n, n bytes to the controller) -> (u64 cycle now, u16 n, n bytes from it), once that many
 * cycles have passed or a frame's end came out. SIGUSR1 presses the reset button, SIGUSR2 stops Timer1 as a fault
 * would, SIGPWR takes its power away for a moment: a reset that leaves nothing in memory. SIGHUP pulls the cable, or
 * puts it back. Ends on SIGTERM or the end of its input, and then writes to standard error the lowest address that the
 * stack came to.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include <simavr/avr_extint.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>

#define CYCLES_PER_BYTE 640 /* 250 kbaud at 16 MHz */
#define CYCLES_PER_TICK 3200
#define CYCLES_PER_RECORD 80000 /* of no channel */
#define NO_CHANNEL 255
#define TIMSK1 0x6F

struct bytes { uint8_t at[1 << 16]; uint16_t in, out; };

static avr_t *avr;
static struct bytes to_controller, from_controller;
static avr_cycle_count_t ticked;
static FILE *pins;
static uint8_t levels[8];
static double flip, drop, duplicate;
static uint64_t random_state = 1;
static int frame_ended, uart_full;
static volatile sig_atomic_t ended, reset_pressed, power_lost, timer_stopped, cable_moved;

static void on_signal(int which)
{
    ended |= which == SIGTERM;
    reset_pressed |= which == SIGUSR1 || which == SIGPWR;
    power_lost |= which == SIGPWR;
    timer_stopped |= which == SIGUSR2;
    cable_moved |= which == SIGHUP;
}

static double uniform(void) /* xorshift64* */
{
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return (double)((random_state * 2685821657736338717ULL) >> 11) / 9007199254740992.0;
}

static void put(struct bytes *line, uint8_t byte)
{
    if (uniform() < flip)
        byte ^= (uint8_t)(1u << (int)(8 * uniform()));
    if (uniform() >= drop)
        line->at[line->in++] = byte;
    if (uniform() < duplicate)
        line->at[line->in++] = byte;
}

static void on_byte_sent(struct avr_irq_t *irq, uint32_t value, void *param)
{
    put(&from_controller, (uint8_t)value);
    frame_ended |= value == 0;
}

static avr_cycle_count_t recorded;

static void record(uint8_t channel, uint8_t level)
{
    struct { uint64_t cycle; uint8_t channel, level, pad[6]; } now = { avr->cycle, channel, level, { 0 } };
    fwrite(&now, sizeof now, 1, pins);
    recorded = avr->cycle;
}

static void on_pin(struct avr_irq_t *irq, uint32_t value, void *param)
{
    uint8_t channel = (uint8_t)(intptr_t)param, level = value & 1;
    if (levels[channel] != level)
        record(channel, level);
    levels[channel] = level;
}

static void flush_pins(void)
{
    if (avr->cycle - recorded >= CYCLES_PER_RECORD)
        record(NO_CHANNEL, 0);
    fflush(pins);
}

/* simavr's UART takes a little longer for a byte than the line, and gathers 64 of them meanwhile. */
static void on_flow(struct avr_irq_t *irq, uint32_t value, void *param)
{
    uart_full = param != NULL;
}

/* Feeds the line at its pace, and keeps a sleeping core from jumping further than a tick. */
static avr_cycle_count_t tick(struct avr_t *mcu, avr_cycle_count_t when, void *param)
{
    ticked = mcu->cycle;
    if (to_controller.in == to_controller.out)
        return when + CYCLES_PER_TICK;
    if (uart_full)
        return when + CYCLES_PER_BYTE;
    avr_raise_irq(avr_io_getirq(mcu, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT), to_controller.at[to_controller.out++]);
    return when + CYCLES_PER_BYTE;
}

static void do_not_sleep(struct avr_t *mcu, avr_cycle_count_t cycles) { }

static void say_nothing(avr_t *mcu, const int level, const char *format, va_list ap) { }

static void start_ticking(void)
{
    avr_extint_set_strict_lvl_trig(avr, 0, 0); /* else PD2 and PD3 low would be polled */
    avr_extint_set_strict_lvl_trig(avr, 1, 0);
    avr_cycle_timer_register(avr, CYCLES_PER_TICK, tick, NULL);
    ticked = avr->cycle;
}

static uint16_t lowest_stack = 0xFFFF;

static void run(avr_cycle_count_t until, int or_frame)
{
    frame_ended = 0;
    while (avr->cycle < until && !(or_frame && frame_ended)) {
        if (reset_pressed) {
            reset_pressed = 0;
            avr_reset(avr);
            for (uint16_t at = 0x100; power_lost && at <= avr->ramend; at++)
                avr->data[at] = (uint8_t)(256 * uniform());
            power_lost = 0;
            for (int i = 0; i < 8; i++)
                on_pin(NULL, 0, (void *)(intptr_t)i);
            record(NO_CHANNEL, 1);
        }
        if (timer_stopped) {
            timer_stopped = 0;
            avr_core_watch_write(avr, TIMSK1, 0);
        }
        int state = avr_run(avr);
        if (state == cpu_Done || state == cpu_Crashed) {
            fprintf(stderr, "the controller crashed\n");
            exit(1);
        }
        if (avr->cycle - ticked > 4 * CYCLES_PER_TICK) /* a reset took the timer away */
            start_ticking();
        uint16_t stack = (uint16_t)(avr->data[R_SPL] | avr->data[R_SPH] << 8);
        if (stack > 0x100 && stack < lowest_stack)
            lowest_stack = stack;
    }
}

static void lockstep(FILE *replies)
{
    struct __attribute__((packed)) { uint32_t cycles; uint16_t n; } ask;
    struct __attribute__((packed)) { uint64_t cycle; uint16_t n; } reply;
    uint8_t bytes[1 << 16];
    while (!ended && fread(&ask, sizeof ask, 1, stdin) == 1) {
        if (fread(bytes, 1, ask.n, stdin) != ask.n)
            return;
        for (int i = 0; i < ask.n; i++)
            put(&to_controller, bytes[i]);
        run(avr->cycle + ask.cycles, 1);
        reply.cycle = avr->cycle;
        reply.n = (uint16_t)(from_controller.in - from_controller.out);
        for (int i = 0; i < reply.n; i++)
            bytes[i] = from_controller.at[from_controller.out++];
        flush_pins();
        fwrite(&reply, sizeof reply, 1, replies);
        fwrite(bytes, 1, reply.n, replies);
        fflush(replies);
    }
}

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static int line = -1, other_end = -1;

static void move_cable(const char *link)
{
    unlink(link);
    if (line >= 0) {
        close(line);
        close(other_end); /* was held open so that the line stays up between two hosts */
        line = -1;
        return;
    }
    char name[256];
    struct termios raw;
    if (openpty(&line, &other_end, name, NULL, NULL) || tcgetattr(other_end, &raw))
        exit(1);
    cfmakeraw(&raw);
    tcsetattr(other_end, TCSANOW, &raw);
    fcntl(line, F_SETFL, O_NONBLOCK);
    if (symlink(name, link))
        exit(1);
}

static void real_time(const char *link)
{
    double began = now() - (double)avr->cycle / 16e6;
    uint8_t bytes[4096];
    move_cable(link);
    while (!ended) {
        if (cable_moved) {
            cable_moved = 0;
            move_cable(link);
        }
        ssize_t n = read(line, bytes, sizeof bytes);
        for (ssize_t i = 0; i < n; i++)
            put(&to_controller, bytes[i]);
        run(avr->cycle + 8000, 0);
        for (n = 0; from_controller.out != from_controller.in && n < (ssize_t)sizeof bytes; n++)
            bytes[n] = from_controller.at[from_controller.out++];
        if (n && write(line, bytes, (size_t)n) < 0 && errno != EAGAIN && errno != EBADF) /* nobody listens: lost */
            return;
        double ahead = began + (double)avr->cycle / 16e6 - now();
        flush_pins();
        if (ahead > 0)
            usleep((useconds_t)(1e6 * ahead));
        else if (ahead < -0.05) /* the host machine stalled us: a controller would not have been; do not hurry after */
            began -= ahead;
    }
    unlink(link);
}

int main(int argc, char **argv)
{
    elf_firmware_t firmware = { { 0 } };
    FILE *replies = fdopen(dup(1), "wb");
    dup2(2, 1); /* simavr chats on standard output */
    const char *link = NULL;
    if (argc < 4 || elf_read_firmware(argv[1], &firmware) || !(pins = fopen(argv[2], "wb")))
        return 2;
    for (int i = 3; i < argc; i += 2) {
        const char *value = i + 1 < argc ? argv[i + 1] : "";
        if (!strcmp(argv[i], "--pty")) link = value;
        if (!strcmp(argv[i], "--flip")) flip = atof(value);
        if (!strcmp(argv[i], "--drop")) drop = atof(value);
        if (!strcmp(argv[i], "--duplicate")) duplicate = atof(value);
        if (!strcmp(argv[i], "--seed")) random_state = 2 * strtoull(value, NULL, 10) + 1;
        if (!strcmp(argv[i], "--lockstep")) i--;
    }
    struct sigaction action = { .sa_handler = on_signal, .sa_flags = SA_RESTART };
    sigaction(SIGUSR1, &action, NULL);
    sigaction(SIGUSR2, &action, NULL);
    sigaction(SIGPWR, &action, NULL);
    sigaction(SIGHUP, &action, NULL);
    action.sa_flags = 0;
    sigaction(SIGTERM, &action, NULL);

    avr = avr_make_mcu_by_name("atmega328p");
    avr_init(avr);
    avr_global_logger_set(say_nothing);
    avr->sleep = do_not_sleep;
    avr_load_firmware(avr, &firmware);
    avr->frequency = 16000000;

    uint32_t flags = 0;
    avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), on_byte_sent, NULL);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUT_XON), on_flow, NULL);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUT_XOFF), on_flow, &uart_full);
    for (int i = 0; i < 8; i++) {
        avr_irq_t *pin = i < 6 ? avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('D'), i + 2)
            : avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('B'), i - 6);
        avr_irq_register_notify(pin, on_pin, (void *)(intptr_t)i);
    }
    start_ticking();
    if (link)
        real_time(link);
    else
        lockstep(replies);
    fclose(pins);
    fprintf(stderr, "lowest stack address 0x%03x\n", lowest_stack);
    return 0;
}
