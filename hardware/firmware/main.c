/* Servo controller for a drawing arm: an ATmega328P at 16 MHz (Arduino Uno or Nano). See PROTOCOL.md. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/wdt.h>

#include "frames.h"
#include "machine.h"
#include "protocol.h"
#include "pulses.h"
#include "uart.h"

/* A watchdog that has struck stays on at its shortest, and would strike again before main(). */
void watchdog_off(void) __attribute__((naked, used, section(".init3")));
void watchdog_off(void)
{
    MCUSR = 0;
    wdt_disable();
}

/* Gathers bytes up to a delimiter and hands on what was between. */
static void receive(uint8_t byte)
{
    static uint8_t bytes[LONGEST_FRAME];
    static uint8_t n;
    if (byte) {
        if (n < sizeof bytes)
            bytes[n] = byte;
        if (n <= sizeof bytes)
            n++; /* up to one past the end: too long to be a frame */
        return;
    }
    if (n) {
        uint8_t length = n <= sizeof bytes ? frame_decode(bytes, n) : 0;
        if (length)
            machine_receive(bytes, length);
        else
            machine_receive_damaged();
    }
    n = 0;
}

static void answer(void)
{
    uint8_t body[LONGEST_BODY];
    uint8_t n = machine_answer(body);
    uart_send(frame_encode(body, n, uart_frame()));
}

/* Idle until an interrupt; at once where one has brought work already. */
static void rest(void)
{
    cli();
    if (!uart_has_byte() && !pulses_slot_is_due()) {
        sleep_enable();
        sei(); /* holds off interrupts for one more instruction */
        sleep_cpu();
        sleep_disable();
    }
    sei();
}

int main(void)
{
    uint8_t byte, channel;
    uart_start();
    pulses_start();
    machine_start();
    wdt_enable(WDTO_250MS);
    sei();
    for (;;) {
        while (pulses_next_slot(&channel)) {
            machine_slot(channel);
            wdt_reset(); /* only while pulses go on */
        }
        if (uart_take(&byte))
            receive(byte);
        if (machine_has_answer() && uart_is_idle())
            answer();
        rest();
    }
}
