// SPDX-License-Identifier: BSD-3-Clause
// An HTTP server for a page and a stream of events.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace photonav {

struct ServerAddress {
    std::string host = "127.0.0.1";  ///< IP address or host name
    int port = 0;                    ///< 0: any free port
};

/// Parses "PORT", "ADDRESS:PORT" or "[IPV6]:PORT". Without an address, the server uses the loopback
/// interface.
/// @throws InputError naming --serve for any other text, and for a port above 65535
ServerAddress parseServerAddress(const std::string& text);

/// Serves a page at / and server-sent events at /events, in its own threads, to at most 24
/// browsers. A browser that connects late receives all events from the first one on. A slow browser
/// delays neither publish() nor other browsers. On a loopback address, the server answers only
/// requests whose Host header is a loopback address, so that pages of other sites cannot read the
/// events.
class LiveServer {
  public:
    /// Starts to listen.
    /// @param page the HTML page
    /// @throws InputError naming the address if it cannot be used, for example a port in use
    LiveServer(const ServerAddress& address, std::string page);
    LiveServer(const LiveServer&) = delete;
    LiveServer& operator=(const LiveServer&) = delete;
    /// Waits, at most two seconds, until the browsers have received all events; then ends the
    /// server.
    ~LiveServer();

    std::string url() const;  ///< address of the page, "http://127.0.0.1:8080/"

    /// Sends an event to all browsers, including those that connect later. Returns at once.
    /// @param name name of the event
    /// @param data content of the event, without line breaks
    void publish(std::string_view name, std::string_view data);

  private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace photonav
