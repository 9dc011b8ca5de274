#include "output_web/server.hpp"

#include <utility>

#include "output_web/server_loop.hpp"

namespace stillpoint::output_web {

Server::Server(ServerSetup setup, EventLog& events)
    : loop_(std::make_unique<ServerLoop>(std::move(setup), events)) {}

Server::~Server() = default;

std::uint16_t Server::port() const { return loop_->port(); }

void Server::begin(std::shared_ptr<LiveRun> run) { loop_->begin(std::move(run)); }

void Server::notify() { loop_->notify(); }

}  // namespace stillpoint::output_web
