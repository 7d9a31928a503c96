// A CAN bus for a slave in C: slcan over TCP, for one client at a time.

#ifndef SLCAN_H
#define SLCAN_H

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

// A frame.
struct slcan_frame {
    uint32_t id;
    // Whether the CAN-ID has 29 bits.
    bool extended;
    bool rtr;
    uint8_t len;
    uint8_t data[8];
};

static int slcan_server = -1, slcan_client = -1;
static char slcan_text[65536];
static size_t slcan_used;

// Microseconds of a clock that never goes back.
static uint64_t slcan_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000 + (uint64_t)now.tv_nsec / 1000;
}

// Listens to a port of this computer.
static void slcan_open(int port) {
    struct sockaddr_in at = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    int on = 1;
    slcan_server = socket(AF_INET, SOCK_STREAM, 0);
    setsockopt(slcan_server, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (bind(slcan_server, (struct sockaddr *)&at, sizeof at) != 0 || listen(slcan_server, 1) != 0) {
        perror("slcan");
        exit(1);
    }
}

static void slcan_write(const char *text, size_t len) {
    if (slcan_client >= 0 && send(slcan_client, text, len, MSG_NOSIGNAL) < 0) {
        close(slcan_client);
        slcan_client = -1;
    }
}

static void slcan_send(const struct slcan_frame *frame) {
    char line[32];
    char kind = frame->rtr ? 'r' : 't';
    int digits = frame->extended ? 8 : 3;
    int len = sprintf(line, "%c%0*X%u", frame->extended ? kind - 32 : kind, digits, (unsigned)frame->id, frame->len);
    for (int at = 0; at < frame->len && !frame->rtr; at++) {
        len += sprintf(line + len, "%02X", frame->data[at]);
    }
    line[len++] = '\r';
    slcan_write(line, (size_t)len);
}

// Responds to a line of the client. Returns true if it was a frame.
static bool slcan_line(const char *line, struct slcan_frame *frame) {
    unsigned id, len;
    switch (line[0]) {
    case 't':
    case 'r':
    case 'T':
    case 'R': {
        bool extended = line[0] < 'a';
        if (sscanf(line + 1, extended ? "%8x%1u" : "%3x%1u", &id, &len) != 2 || len > 8) {
            slcan_write("\a", 1);
            return false;
        }
        bool rtr = line[0] == 'r' || line[0] == 'R';
        *frame = (struct slcan_frame){.id = id, .extended = extended, .rtr = rtr, .len = (uint8_t)len};
        for (unsigned at = 0; at < len && !frame->rtr; at++) {
            unsigned byte = 0;
            sscanf(line + (extended ? 10 : 5) + 2 * at, "%2x", &byte);
            frame->data[at] = (uint8_t)byte;
        }
        slcan_write(extended ? "Z\r" : "z\r", 2);
        return true;
    }
    case 'V': slcan_write("V1013\r", 6); return false;
    case 'N': slcan_write("N0001\r", 6); return false;
    case 'F': slcan_write("F00\r", 4); return false;
    default: slcan_write("\r", 1); return false;
    }
}

// Waits at most `millis` milliseconds for input, and returns true with the next frame.
static bool slcan_next(int millis, struct slcan_frame *frame) {
    for (;;) {
        char *end = memchr(slcan_text, '\r', slcan_used);
        if (end != NULL) {
            char line[64] = "";
            size_t len = (size_t)(end - slcan_text);
            memcpy(line, slcan_text, len < sizeof line - 1 ? len : sizeof line - 1);
            slcan_used -= len + 1;
            memmove(slcan_text, end + 1, slcan_used);
            if (slcan_line(line, frame)) {
                return true;
            }
            continue;
        }
        struct pollfd wait[2] = {{slcan_server, POLLIN, 0}, {slcan_client, POLLIN, 0}};
        if (poll(wait, slcan_client < 0 ? 1 : 2, millis) <= 0) {
            return false;
        }
        if (wait[0].revents != 0) {
            int on = 1;
            close(slcan_client);
            slcan_client = accept(slcan_server, NULL, NULL);
            setsockopt(slcan_client, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
            slcan_used = 0;
        } else {
            ssize_t count = recv(slcan_client, slcan_text + slcan_used, sizeof slcan_text - slcan_used, 0);
            if (count <= 0) {
                close(slcan_client);
                slcan_client = -1;
                slcan_used = 0;
                return false;
            }
            slcan_used += (size_t)count;
        }
    }
}

#endif
