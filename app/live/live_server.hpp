// SPDX-License-Identifier: BSD-3-Clause
// A page and a stream of events for browsers, over HTTP.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace photonav {

struct ServerAddress {
    std::string host = "127.0.0.1";  ///< numeric, or a name
    int port = 0;                    ///< 0: a free one
};

/// "PORT", "ADDRESS:PORT" or "[IPV6]:PORT"; the loopback interface where no address is given.
/// @throws InputError naming --serve for anything else, and for a port above 65535
ServerAddress parseServerAddress(const std::string& text);

/// Serves a page at / and events at /events (server-sent events) from threads of its own. A browser
/// that comes late gets all events from the first one on; one that is slow, or leaves, delays
/// nothing but itself. On a loopback address, only requests that name such an address as their host
/// are answered, so that no page of another site can read along.
class LiveServer {
  public:
    /// Listens from here on.
    /// @param page HTML
    /// @throws InputError naming the address where it cannot be used: a port in use, for example
    LiveServer(const ServerAddress& address, std::string page);
    LiveServer(const LiveServer&) = delete;
    LiveServer& operator=(const LiveServer&) = delete;
    /// Waits until the browsers have got all events, at most two seconds, and ends.
    ~LiveServer();

    std::string url() const;  ///< "http://127.0.0.1:8080/"

    /// Sends an event to all browsers, those to come included. Returns at once.
    /// @param name of the event; @param data one line
    void publish(std::string_view name, std::string_view data);

  private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace photonav
